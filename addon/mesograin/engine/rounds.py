# How many samples a final render draws next, until its scene's budget is spent; and what came of it, in a sentence.
from .. import native_module
from ..durations import duration
from ..scene import budgets
from . import stated_error
from .pace import Pace


def of(settings, values, started, views):
    """[Samples, UntilError or UntilTime] for each of so many views of a render that began then, in seconds. settings:
    properties.SceneProperties; values: export.SceneValues."""
    if settings.budget == budgets.ERROR:
        return [UntilError(0.01 * settings.budget_error, values.error_of_models()) for _ in range(views)]
    if settings.budget == budgets.TIME:
        each = settings.budget_seconds / views
        return [UntilTime(each, started + each * number) for number in range(views)]
    return [Samples(settings.samples) for _ in range(views)]


class Samples:
    """So many, whatever comes of them."""

    patient = True  # whether all is to be known of light in and between grains before the first

    def __init__(self, target):
        self._pace = Pace(target)

    def waits_for_light(self, now):
        """Whether samples of one that is not patient are yet to wait for that; now: in seconds."""
        return self.patient

    def next(self, samples, read, now):
        """How many come next; 0 if that is all. samples: there are; read: function that gives the picture of them."""
        return self._pace.target - samples

    def is_over(self, now):
        """Whether no more are to be drawn, whatever `next` said."""
        return False

    def note(self, samples, now):
        """There are so many."""
        self._pace.note(samples, now)

    def share(self, samples, now):
        """Of all there is to do, that is done."""
        return min(1.0, samples / self._pace.target)

    def line(self, now):
        """What is said over the picture."""
        return self._pace.line()

    def sentence(self, samples):
        """What came of it, without a full stop; empty if that is what was asked for. samples: that were drawn."""
        return ""

    def better_exchange(self, exchange):
        """The name of the way of finding light between grains that serves in place of `heaps`; None if that does. To be
        asked once, after the first samples. exchange: as native.View.statistics() tells of it, None where there is none
        of that light."""
        return None


class UntilError(Samples):
    """Until the noise of a pixel is no more than this share of its light."""

    def __init__(self, error, error_of_models):
        """error_of_models: what those of Auto were measured to be off, in %; None if there are none."""
        self._error, self._until = error, native_module.get().UntilError(error)
        self._why = ""
        if error_of_models is not None:
            self._why = f"; Auto's models were measured to be within {error_of_models:.2g}%"
        super().__init__(self._until.target)

    def next(self, samples, read, now):
        if samples == 0:
            return self._until.first
        count = self._until.next(read(), samples)
        self._pace.target = self._until.target
        return count

    def line(self, now):
        noise = self._until.noise
        return self._pace.line() + ("" if noise is None else f", noise {noise:.1%}")

    def sentence(self, samples):
        noise = self._until.noise
        left = "" if noise is None else f" leave noise of {noise:.1%} a pixel"
        return f"{samples} samples{left}, for an error of {100.0 * self._error:.3g}%{self._why}"

    def better_exchange(self, exchange):
        if exchange is None:
            return None
        told, closer = (stated_error.in_blocks({**exchange, "gathered": gathered})
                        for gathered in (exchange["gathered"], True))
        if told is None:
            self._why += "; how far off light between grains is was not measured for grains like these"
        elif told <= self._error or closer >= told:
            self._why += f"; light between grains was measured to be within {told:.1%} in blocks"
        else:
            self._why += (f"; light between grains is gathered, which was measured to be within {closer:.1%} in blocks,"
                          f" and within {told:.1%} otherwise")
            self._until = native_module.get().UntilError(self._error)
            return "gathered"
        return None


class UntilTime(Samples):
    """For so many seconds, and one sample at least."""

    patient = False

    def __init__(self, seconds, started):
        super().__init__(1)
        self._seconds, self._started, self._until = seconds, started, native_module.get().UntilTime(seconds)
        self._samples = 0

    def waits_for_light(self, now):
        return self._until.waits_for_light(now - self._started)

    def next(self, samples, read, now):
        return self._until.next(samples, now - self._started)

    def is_over(self, now):
        return self._until.is_over(now - self._started)

    def note(self, samples, now):
        self._samples = samples

    def share(self, samples, now):
        return min(1.0, max(0.0, (now - self._started) / self._seconds))

    def line(self, now):
        return f"Sample {self._samples}, about {duration(max(0.0, self._started + self._seconds - now))} left"

    def sentence(self, samples):
        return f"{samples} sample{'s' if samples != 1 else ''} in {duration(self._seconds)}"

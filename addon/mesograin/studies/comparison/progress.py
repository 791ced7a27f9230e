# What is under way and how long the rest will take, as one line or as calls.
"""See `Progress` and `Calls`."""

import sys
import threading
import time
from dataclasses import dataclass

from ...durations import duration


@dataclass(frozen=True)
class Step:
    """The step `number` of `count` is under way. fraction: of this step, 0 to 1. seconds_left: the guess for all
    steps that are not done. share: of all steps' time, that has passed. is_guess: whether count is one."""

    number: int
    count: int
    what: str
    fraction: float
    seconds_left: float
    share: float = 0.0
    is_guess: bool = False


class Cancelled(Exception):
    """Somebody called `Progress.cancel`."""


class Progress:
    """Steps with guessed costs; each step that ends corrects the guess of those of its kind.

    stream: where the line goes. On a terminal it is rewritten in place, elsewhere printed at most every `interval`
    seconds.
    """

    def __init__(self, stream=sys.stderr, interval=15.0):
        self._stream = stream
        self._in_place = stream.isatty()
        self._interval = 0.2 if self._in_place else interval
        self._steps = []
        self._pace = {}
        self._at = -1
        self._fraction = 0.0
        self._started = self._begun = time.monotonic()
        self._is_guess = False
        self._shown = 0.0
        self._lock = threading.Lock()
        self._cancelled = False

    def plan(self, steps, is_guess=False):
        """steps: [(what, kind, guessed seconds)], in the order in which `begin` will be called. is_guess: whether there
        may come more or fewer."""
        self._steps, self._is_guess = list(steps), is_guess
        self._begun = time.monotonic()

    def insert(self, steps):
        """Steps that come before all that are planned, as in `plan`."""
        with self._lock:
            self._steps[self._at + 1:self._at + 1] = list(steps)

    def cancel(self):
        """From any thread: the next step is not begun."""
        self._cancelled = True

    def begin(self):
        """The next step is under way. Raises Cancelled after `cancel`."""
        if self._cancelled:
            raise Cancelled("The comparison was cancelled.")
        with self._lock:
            self._at += 1
            self._fraction = 0.0
            self._started = time.monotonic()
            self._show(force=True)

    def update(self, fraction):
        """How much of the step is done, 0 to 1; from any thread."""
        with self._lock:
            self._fraction = min(max(fraction, self._fraction), 1.0)
            self._show()

    def end(self, learn=True):
        """The step is done. learn: whether its time says something about others of its kind (not if it was cached)."""
        with self._lock:
            _, kind, guess = self._steps[self._at]
            if learn and guess > 0.0:
                self._pace[kind] = (time.monotonic() - self._started, guess)
            self._fraction = 1.0

    @property
    def steps_left(self):
        """How many steps have not begun."""
        return len(self._steps) - self._at - 1

    def skip_to_last(self, count):
        """Gives up on all steps but the last `count`."""
        with self._lock:
            self._at = len(self._steps) - count - 1
            self._fraction = 1.0

    def say(self, sentence):
        """A line of its own."""
        with self._lock:
            self._clear()
            print(sentence, file=self._stream, flush=True)

    def close(self):
        """Leaves the terminal's line empty."""
        with self._lock:
            self._clear()

    def seconds_left(self):
        """The guess for all that is not done."""
        elapsed = time.monotonic() - self._started
        left = 0.0
        for index, (_, kind, guess) in enumerate(self._steps):
            pace = self._pace_of(kind)
            if index > self._at:
                left += guess * pace
            elif index == self._at and self._fraction < 1.0:
                # What the step shows of itself outweighs the guess as it advances.
                seen = elapsed / self._fraction if self._fraction > 0.02 else guess * pace
                total = self._fraction * seen + (1.0 - self._fraction) * max(guess * pace, elapsed)
                left += max(total * (1.0 - self._fraction), 0.0)
        return left

    def _pace_of(self, kind):
        """Seconds for a guessed second: of the last step of this kind, else of all kinds together."""
        taken = [self._pace[kind]] if kind in self._pace else list(self._pace.values())
        guessed = sum(guess for _, guess in taken)
        return sum(seconds for seconds, _ in taken) / guessed if guessed else 1.0

    def _show(self, force=False):
        now = time.monotonic()
        if not force and now - self._shown < self._interval:
            return
        self._shown = now
        what = self._steps[self._at][0]
        passed, left = now - self._begun, self.seconds_left()
        share = passed / (passed + left) if passed + left > 0.0 else 0.0
        self._draw(Step(self._at + 1, len(self._steps), what, self._fraction, left, share, self._is_guess))

    def _draw(self, step):
        place = f"{step.number}/{step.count}"
        if step.is_guess:  # of which the last is not known to be the last
            place = f"{step.number} of about {step.count}" if step.number < step.count else f"{step.number}"
        line = f"[{place}] {step.what}, {step.share:.0%} of all, about {duration(step.seconds_left)} left"
        if self._in_place:
            self._stream.write(f"\r\033[K{line}")
            self._stream.flush()
        else:
            print(line, file=self._stream, flush=True)

    def _clear(self):
        if self._in_place:
            self._stream.write("\r\033[K")
            self._stream.flush()


class Calls(Progress):
    """Tells a program instead of a person: calls `on_step(Step)` at most every `interval` seconds, and
    `on_sentence(str)`; from any thread."""

    def __init__(self, on_step, on_sentence, interval=0.2):
        super().__init__()
        self._interval = interval
        self._on_step = on_step
        self._on_sentence = on_sentence

    def say(self, sentence):
        self._on_sentence(sentence)

    def close(self):
        """There is no line to be left empty."""

    def _draw(self, step):
        self._on_step(step)

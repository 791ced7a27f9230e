"""How coarse a viewport's first picture is, by what samples took before."""
import random

import pytest
from mesograin.engine.coarseness import COARSEST, FIRST, FOLLOWING_SECONDS, Coarseness, finer, size


class Viewport:
    """Of which a sample takes fixed + varying / divisor² seconds, and up to `disturbed` times that."""

    def __init__(self, disturbed=1.0):
        self.coarseness, self._random, self._disturbed = Coarseness(), random.Random(1), disturbed

    def drag(self, fixed, varying, changes=6):
        """The divisors of the first pictures."""
        divisors = []
        for _ in range(changes):
            divisors.append(self.coarseness.divisor())
            self._draw(divisors[-1], fixed, varying)
        return divisors

    def rest(self, fixed, varying):
        """No change comes: finer pictures, and sharp samples."""
        divisor = self.coarseness.divisor()
        while divisor > 1:
            self._draw(divisor, fixed, varying)
            divisor = finer(divisor)
        for _ in range(8):
            self._draw(1, fixed, varying)

    def _draw(self, divisor, fixed, varying):
        self.coarseness.note(divisor, (fixed + varying / divisor**2) * self._random.uniform(1.0, self._disturbed))


def sharpest(varying):
    within = [divisor for divisor in range(1, COARSEST + 1) if varying / divisor**2 <= FOLLOWING_SECONDS]
    return min(within, default=COARSEST)


TIMES = [1e-3, 0.05, 0.3, 1.0, 3.0]


@pytest.mark.parametrize("seconds", TIMES)
def test_it_is_the_sharpest_picture_that_follows(seconds):
    viewport = Viewport()
    viewport.rest(0.0, seconds)
    assert viewport.drag(0.0, seconds) == [sharpest(seconds)] * 6


@pytest.mark.parametrize("seconds", TIMES)
def test_a_picture_does_not_flicker_where_the_machine_is_busy(seconds):
    viewport = Viewport(disturbed=2.0)
    for _ in range(20):
        viewport.rest(0.0, seconds)
        divisors = viewport.drag(0.0, seconds, 40)
        assert divisors == sorted(divisors) and len(set(divisors)) <= 2
        assert sharpest(seconds) <= divisors[-1] <= sharpest(2.0 * seconds) + 1


def test_nothing_is_drawn_coarse_that_comes_no_sooner_for_it():
    viewport = Viewport()
    viewport.rest(1.0, 0.2)
    viewport.drag(1.0, 0.2)
    viewport.rest(1.0, 0.2)
    assert set(viewport.drag(1.0, 0.2)) == {1}
    viewport.rest(1.0, 0.2)
    assert set(viewport.drag(1.0, 0.2)) == {1}


def test_the_first_picture_of_all_is_coarse():
    assert Coarseness().divisor() == FIRST > 1


@pytest.mark.parametrize("before", [(0.0, 0.05), (0.0, 0.4), (5.0, 0.2), (0.0, 10.0)])
@pytest.mark.parametrize("after", TIMES)
def test_another_scene_is_followed_once_it_was_seen_sharp(before, after):
    viewport = Viewport()
    viewport.rest(*before)
    viewport.drag(*before)
    viewport.rest(*before)
    viewport.rest(0.0, after)
    assert viewport.drag(0.0, after) == [sharpest(after)] * 6


def test_a_scene_that_becomes_slow_amid_a_drag_is_followed():
    """As of a million grains from one change to the next."""
    viewport = Viewport()
    for before in (0.05, 0.4):
        viewport.rest(0.0, before)
        viewport.drag(0.0, before)
        seconds = viewport.drag(0.0, 6.0)
        assert seconds[3] >= FIRST and seconds[-1] == COARSEST


def test_a_sharp_picture_may_still_be_under_way_when_a_coarse_one_is_asked_for():
    """And the coarse one take longer, as of a scene that has become slow."""
    coarseness = Coarseness()
    coarseness.divisor()
    for divisor, seconds in ((1, 0.1), (4, 0.5), (1, 3.0)):
        coarseness.note(divisor, seconds)
    assert coarseness.divisor() == COARSEST


@pytest.mark.parametrize("seed", range(20))
def test_samples_of_any_kind_may_come_in_any_order(seed):
    drawn, coarseness = random.Random(seed), Coarseness()
    for _ in range(2000):
        if drawn.random() < 0.3:
            assert 1 <= coarseness.divisor() <= COARSEST
        coarseness.note(drawn.choice((1, 1, 2, 4, COARSEST)), 10.0 ** drawn.uniform(-4.0, 1.0))


def test_pictures_become_finer_to_the_last():
    for divisor in range(2, COARSEST + 1):
        steps = [divisor]
        while steps[-1] > 1:
            steps.append(finer(steps[-1]))
        assert steps[-1] == 1 and steps == sorted(steps, reverse=True)


def test_a_coarse_picture_covers_the_region():
    assert size((1057, 593), 1) == (1057, 593)
    assert size((1057, 593), 4) == (265, 149)
    assert size((1, 2), 6) == (1, 1)


def test_what_a_sample_is_expected_to_take_is_what_the_last_one_of_its_size_took():
    coarseness = Coarseness()
    assert coarseness.expected(4) is None
    coarseness.note(4, 0.03)
    assert coarseness.expected(4) == 0.03 and coarseness.expected(1) is None
    coarseness.note(1, 0.5)
    assert coarseness.expected(1) == 0.5 and coarseness.expected(4) is None

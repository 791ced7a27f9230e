"""The page of bench heap_light: what meets its bound and what misses it is marked so, beside the pictures."""
import pathlib
import sys

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "bench"))
import heap_light_page  # noqa: E402


def case(**changes):
    return {"kind": "lambert .8", "refracts": False, "light": "sun", "model": "lambert", "exchange": "order_1",
            "total": 1.0, "blocks": 0.03, "truth_noise": 0.004, "finite": True, **changes}


def rows(*cases):
    page = heap_light_page.html(cases, [], spheres=696, size=(96, 96), samples=16, paths=128)
    return [line for line in page.splitlines() if "<td" in line and "class" in line]


def test_a_bound_is_met_or_missed():
    for met, blocks, of in ((True, 0.039, {}), (False, 0.041, {}), (True, 0.065, {"light": "low"}),
                            (False, 0.026, {"exchange": "gathered"}), (True, 0.079, {"refracts": True})):
        [row] = rows(case(blocks=blocks, **of))
        assert ('"met">%.1f' % (100.0 * blocks) in row) == met and ('"missed">%.1f' % (100.0 * blocks) in row) != met
    [row] = rows(case(total=1.04))
    assert '"missed">1.040' in row


def test_what_has_no_light_between_grains_has_no_bound():
    assert heap_light_page.bound(case(exchange="off")) is None and not rows(case(exchange="off"))


def test_pictures_are_in_the_page():
    truth = numpy.full((4, 4, 3), 0.5)
    row = heap_light_page.pictures_of("lambert .8", "sun", truth, [("order_1", 1.1 * truth)])
    page = heap_light_page.html([case()], [row], spheres=696, size=(96, 96), samples=16, paths=128)
    assert page.count("data:image/png;base64,iVBOR") == 3 and "order_1 less the truth" in page

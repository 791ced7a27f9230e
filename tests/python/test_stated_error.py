"""What is said of the error of light between grains: only of what was held against path tracing."""
import importlib.util
import pathlib

import pytest

PATH = pathlib.Path(__file__).resolve().parents[2] / "addon/mesograin/engine/stated_error.py"


@pytest.fixture(scope="module", name="stated_error")
def module():
    spec = importlib.util.spec_from_file_location("stated_error", PATH)
    loaded = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(loaded)
    return loaded


def exchange(balls=True, gathered=True, **stuff):
    return {"balls": balls, "gathered": gathered, "levels": {"own_shape": 9, "ball": 0, "told": 0, "surface": 0},
            "stuff": [{"surface": "index_matched", "thickness": (3.0, 3.0), "albedo": (0.9, 0.999), "g": (0.0, 0.0),
                       "eta": (1.0, 1.0), **stuff}]}


SALT = {"surface": "dielectric", "thickness": (0.3, 1.0), "albedo": (0.9, 0.99), "eta": (1.544, 1.544)}


def test_it_is_said_of_what_was_measured(stated_error):
    assert stated_error.sentence(exchange()).startswith("within 3% in all and 3.3% in blocks")
    for balls in (True, False):
        assert stated_error.sentence(exchange(balls, **SALT)).startswith("within ")
    # Heaps whose grains lie in each other are up to 18 % off beside Cycles, and of no kind that was measured.
    assert "do not lie in each other" in stated_error.sentence(exchange())
    forward = exchange(albedo=(0.99, 0.99), g=(0.6, 0.6))
    assert stated_error.sentence(forward).startswith("within 2% in all and 3.7% in blocks")
    both = exchange()
    both["stuff"] += exchange(**SALT)["stuff"]
    assert float(stated_error.sentence(both).split("and ")[1].split("%")[0]) > 3.3


def test_of_heaps_by_chance_nine_in_ten_are_told(stated_error):
    for of in ({"thickness": (0.2, 3.0)}, {"albedo": (0.6, 0.9), "g": (0.5, 0.5)}, {**SALT, "albedo": (0.6, 0.9)}):
        sentence = stated_error.sentence(exchange(balls=False, **of))
        assert "nine in ten of 1" in sentence and "do not lie in each other" in sentence
    # What was measured of chosen kinds is said before that.
    assert "chance" not in stated_error.sentence(exchange())
    both = exchange(balls=False, thickness=(0.2, 3.0))
    both["stuff"] += exchange(**SALT)["stuff"]
    assert "blocks of 8 x 8 pixels for nine in ten of 16 heaps" in stated_error.sentence(both)
    assert stated_error.in_blocks(both) >= stated_error.in_blocks(exchange(balls=False, **SALT))


def test_more_is_said_of_grains_that_are_seen_small(stated_error):
    for level in ("ball", "told", "surface"):
        seen = exchange()
        seen["levels"][level] = 1
        assert stated_error.sentence(seen) == (stated_error.sentence(exchange())
                                               + ", and 6% more in blocks of grains below 8 pixels across")


@pytest.mark.parametrize("other", [{"thickness": (0.01, 3.0)}, {"thickness": (3.0, 11.0)}, {"albedo": (0.5, 0.9)},
                                   {"g": (0.85, 0.85)}, {"g": (-0.3, 0.0)}, {"surface": "mirror"},
                                   {**SALT, "eta": (1.1, 1.544)}, {**SALT, "eta": (1.8, 1.8)}])
def test_nothing_is_said_of_what_was_not(stated_error, other):
    assert "not measured" in stated_error.sentence(exchange(**other))

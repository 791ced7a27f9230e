# One test for each check that driver.py runs in a real Blender window on a virtual screen. Runs outside Blender:
#   MESOGRAIN_BLENDER=/usr/bin/blender python3 -m pytest tests/window
import ast
import functools
import os
import tempfile

import pytest
from launch import HERE, launch

EMPTY_FOLDER = tempfile.mkdtemp(prefix="mesograin-no-native-")
SMALLEST, SMALL, TALL, TALLER = (640, 480), (900, 640), (1100, 1000), (1100, 1400)
SIMULATED = ["--enable-event-simulate"]
LIMIT = 1500 + 3 * int(os.environ.get("MESOGRAIN_MONKEY", "0"))  # s, of one launch
LAUNCHES = {  # what is checked, in which environment, on a screen of which size, with which of Blender's options
    "viewport": ("checks_viewport", {}, SMALL, SIMULATED),
    "upheaval": ("checks_upheaval", {}, TALL, SIMULATED),
    "cancel": ("checks_cancel", {}, SMALL, []),
    "monkey": ("checks_monkey", {}, SMALLEST, []),
    "heap": ("checks_heap", {}, SMALL, SIMULATED),
    "pile": ("checks_pile", {}, SMALL, SIMULATED),
    "keys": ("checks_keys", {}, TALL, SIMULATED),
    "compare": ("checks_compare", {}, TALL, SIMULATED),
    "bake": ("checks_bake", {}, TALLER, SIMULATED),
    "preview": ("checks_preview", {}, TALLER, SIMULATED),
    "no_native_module": ("checks_unavailable", {"MESOGRAIN_NATIVE_DIR": EMPTY_FOLDER}, SMALL, SIMULATED),
    "no_device": ("checks_unavailable", {"MESOGRAIN_GL_DEVICE": "nonexistent"}, SMALL, SIMULATED),
}


def names_of_checks(module):
    tree = ast.parse((HERE / f"{module}.py").read_text())
    return [node.name for node in tree.body if isinstance(node, ast.FunctionDef) and node.name.startswith("check_")]


CASES = [(launch, name) for launch, (module, *_) in LAUNCHES.items() for name in names_of_checks(module)]


@pytest.fixture(scope="session")
def launched(tmp_path_factory):
    """launched(name) runs that launch once and gives ({check: traceback or ''}, Blender's output)."""

    @functools.lru_cache(maxsize=None)
    def launch_once(name):
        module, environment, size, options = LAUNCHES[name]
        return launch(module, tmp_path_factory.mktemp(name), size, LIMIT, options, environment)

    yield launch_once
    os.rmdir(EMPTY_FOLDER)


@pytest.mark.parametrize("launch, check", CASES, ids=[f"{launch}-{check}" for launch, check in CASES])
def test_window(launched, launch, check):
    results, output = launched(launch)
    assert check in results, f"Blender ended before this check:\n{output[-4000:]}"
    assert results[check] == "", results[check]


@pytest.mark.parametrize("launch", LAUNCHES)
def test_blender_ends_well_and_shows_no_traceback(launched, launch):
    # The exit code does not tell: Blender ends with 1 after a render that failed as it should.
    _, output = launched(launch)
    # xvfb-run may have the last word, that it could not clean up after itself.
    assert "Blender quit" in output.splitlines()[-3:], f"Blender did not end by itself:\n{output[-4000:]}"
    traceback = output.find("Traceback")
    assert traceback < 0, output[max(traceback - 1000, 0):traceback + 3000]
    # What Blender says of a keyframe dot that shows nothing and does nothing.
    assert "Could not find button" not in output, output[-4000:]

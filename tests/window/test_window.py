# One test for each check that driver.py runs in a real Blender window on a virtual screen. Runs outside Blender:
#   MESOGRAIN_BLENDER=/usr/bin/blender python3 -m pytest tests/window
import ast
import functools
import json
import os
import pathlib
import shutil
import subprocess
import tempfile

import pytest

HERE = pathlib.Path(__file__).resolve().parent
EMPTY_FOLDER = tempfile.mkdtemp(prefix="mesograin-no-native-")
SMALL, TALL, TALLER = (900, 640), (1100, 1000), (1100, 1400)
SIMULATED = ["--enable-event-simulate"]
LIMIT = 900 + 3 * int(os.environ.get("MESOGRAIN_MONKEY", "0"))  # s, of one launch
LAUNCHES = {  # what is checked, in which environment, on a screen of which size, with which of Blender's options
    "viewport": ("checks_viewport", {}, SMALL, SIMULATED),
    "upheaval": ("checks_upheaval", {}, TALL, SIMULATED),
    "cancel": ("checks_cancel", {}, SMALL, []),
    "monkey": ("checks_monkey", {}, SMALL, []),
    "heap": ("checks_heap", {}, SMALL, SIMULATED),
    "pile": ("checks_pile", {}, SMALL, SIMULATED),
    "compare": ("checks_compare", {}, TALL, SIMULATED),
    "bake": ("checks_bake", {}, TALLER, SIMULATED),
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
    def launch(name):
        assert shutil.which("xvfb-run"), "the window tests need xvfb-run, of Debian's package xvfb"
        module, environment, (width, height), options = LAUNCHES[name]
        folder = tmp_path_factory.mktemp(name)
        # The window fills the screen, and no mouse pointer hides a pixel of it.
        screen = f"-screen 0 {width}x{height}x24 -fbdir {folder} -nocursor"
        command = ["xvfb-run", "--auto-servernum", f"--server-args={screen}",
                   os.environ.get("MESOGRAIN_BLENDER", "blender"), "--factory-startup", *options,
                   "--window-geometry", "0", "0", str(width), str(height), "--python-exit-code", "1",
                   "--python", str(HERE / "driver.py"), "--", str(folder), str(folder / "Xvfb_screen0"), module]
        # Installed as an artist has it, so that preferences find it.
        addons = folder / "scripts" / "addons"
        addons.mkdir(parents=True)
        (addons / "mesograin").symlink_to(HERE.parents[1] / "addon" / "mesograin")
        environment = {**os.environ, "BLENDER_USER_SCRIPTS": str(addons.parent), **environment}
        run = subprocess.run(command, env=environment, stdout=subprocess.PIPE,
                             stderr=subprocess.STDOUT, text=True, timeout=LIMIT)
        results = folder / "results.json"
        return (json.loads(results.read_text()) if results.exists() else {}), run.stdout

    yield launch
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
    assert "Traceback" not in output, output[-4000:]

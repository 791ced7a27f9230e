# Starts a Blender window on a virtual screen of its own and has driver.py run a module of checks in it.
import json
import os
import pathlib
import shutil
import subprocess

HERE = pathlib.Path(__file__).resolve().parent
ADDON = HERE.parents[1] / "addon" / "mesograin"


def launch(module, folder, size, timeout, options=(), environment=None, checks=()):
    """({check: traceback or ''}, Blender's output). folder: where pictures go, an empty pathlib.Path; size: of the
    screen, which the window fills; options: of Blender; environment: beside that of this process; checks: their names,
    all if none."""
    assert shutil.which("xvfb-run"), "the window tests need xvfb-run, of Debian's package xvfb"
    width, height = size
    # No mouse pointer hides a pixel.
    screen = f"-screen 0 {width}x{height}x24 -fbdir {folder} -nocursor"
    command = ["xvfb-run", "--auto-servernum", f"--server-args={screen}",
               os.environ.get("MESOGRAIN_BLENDER", "blender"), "--factory-startup", *options,
               "--window-geometry", "0", "0", str(width), str(height), "--python-exit-code", "1",
               "--python", str(HERE / "driver.py"), "--", str(folder), str(folder / "Xvfb_screen0"), module, *checks]
    # Installed as an artist has it, so that preferences find it.
    addons = folder / "scripts" / "addons"
    addons.mkdir(parents=True)
    (addons / "mesograin").symlink_to(ADDON)
    environment = {**os.environ, "BLENDER_USER_SCRIPTS": str(addons.parent), **(environment or {})}
    with subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as run:
        try:
            output, _ = run.communicate(timeout=timeout)
        except subprocess.TimeoutExpired:
            # What xvfb-run started; by itself it leaves Blender to go on for ever.
            subprocess.run(["pkill", "-KILL", "-P", str(run.pid)], check=False)
            output = run.communicate()[0] + f"\nended after {timeout} s"
    results = folder / "results.json"
    return (json.loads(results.read_text()) if results.exists() else {}), output

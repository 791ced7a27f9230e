# Runs checks inside Blender from a timer, one after the other, and leaves their results as JSON before it quits:
#   blender --factory-startup --enable-event-simulate --python driver.py -- FOLDER SCREEN MODULE [check ...]
# SCREEN is the file in which Xvfb, started with -fbdir, keeps its framebuffer.
import importlib
import json
import pathlib
import sys
import time
import traceback

import bpy

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "blender")]

REFUSED_SECONDS = 5.0
"""So long Blender may let timers write nothing before a check goes on, and fails by it."""


def run_all(window, checks, folder):
    results = {}
    for name, check in checks:
        window.begin(name)
        try:
            yield from check(window)
            window.end()
            results[name] = ""
        except Exception:
            results[name] = traceback.format_exc()
        print(f"{name}: {'failed' if results[name] else 'passed'}", flush=True)
        # After each, lest a crash takes the earlier ones along.
        (folder / "results.json").write_text(json.dumps(results, indent=1))
        yield from window.restore()


def quit_blender():
    """Now, or the seconds after which to try again, where Blender is not yet ready to."""
    from mesograin import compat

    try:
        bpy.ops.wm.quit_blender()
    except RuntimeError as refusal:
        if not compat.refuses_writing(refusal):
            raise
        for area in bpy.context.window_manager.windows[0].screen.areas:
            area.tag_redraw()
        return 0.2
    return None


def rest():
    """What Blender's main loop does for itself where nothing happens, unless events are simulated: else it would take a
    processor from what is waited for."""
    time.sleep(0.005)
    return 0.0


def main():
    import addon_utils

    addon_utils.enable("mesograin", default_set=True)
    bpy.context.preferences.view.show_splash = False  # which would take the first keys for itself
    import window
    from mesograin.engine import writing

    folder, screen, module, *wanted = sys.argv[sys.argv.index("--") + 1:]
    checks = [(name, function) for name, function in vars(importlib.import_module(module)).items()
              if name.startswith("check_") and (not wanted or name in wanted)]
    folder = pathlib.Path(folder)
    steps = run_all(window.Window(folder, pathlib.Path(screen)), checks, folder)

    refused_since = None

    def step():
        nonlocal refused_since
        enabled = hasattr(bpy.types, "MESOGRAIN_OT_nothing")
        if enabled and writing.refused():  # as after a preview, until engine/writing.py has looked
            refused_since = refused_since or time.monotonic()
            if time.monotonic() - refused_since < REFUSED_SECONDS:
                return 0.05
        refused_since = None
        try:
            return next(steps)
        except StopIteration:
            return quit_blender()

    bpy.app.timers.register(rest, persistent=True)
    bpy.app.timers.register(step, first_interval=1.0, persistent=True)


main()

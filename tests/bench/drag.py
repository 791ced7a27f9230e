"""How long an artist who drags waits: from a change to its picture, in a real Blender window on a virtual screen, as
ratios to how long Blender's own redraw in Solid shading takes there after the same change.

    MESOGRAIN_BLENDER=/usr/bin/blender drag.py BUILD [--scenes sphere heap] [--changes 200] [--models lambert ...]
"""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "addon"))

from mesograin.schema.models import NAMES  # noqa: E402

SCREEN = (1280, 720)
LIMIT = 3600  # s, for all of a scene
SCENES = {"sphere": "a grain alone", "heap": "ten thousand grains of sand, a ground, an image of a sky with a sun"}


def percentile(values, share):
    return sorted(values)[min(len(values) - 1, int(share * len(values)))]


def measure(scene, changes, models):
    """{setting: {"wait": [ms], "view_update": [ms], "view_draw": [ms]}}, a number for each change; "size": of the
    viewport."""
    with tempfile.TemporaryDirectory() as folder:
        addons = pathlib.Path(folder, "scripts/addons")
        addons.mkdir(parents=True)
        (addons / "mesograin").symlink_to(HERE.parents[1] / "addon/mesograin")
        out = pathlib.Path(folder, "drag.json")
        width, height = SCREEN
        command = ["xvfb-run", "--auto-servernum", f"--server-args=-screen 0 {width}x{height}x24 -nocursor",
                   os.environ.get("MESOGRAIN_BLENDER", "blender"), "--factory-startup", "--window-geometry", "0", "0",
                   str(width), str(height), "--python", str(HERE / "drag_in_window.py"), "--", str(out), scene,
                   str(changes), *models]
        run = subprocess.run(command, env={**os.environ, "BLENDER_USER_SCRIPTS": str(addons.parent)}, text=True,
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=LIMIT)
        if not out.exists():
            sys.exit(f"Blender measured nothing:\n{run.stdout[-3000:]}")
        return json.loads(out.read_text())


def main():
    parser = argparse.ArgumentParser(prog="./mesograin bench drag", description=__doc__.split("\n\n")[0])
    parser.add_argument("build", help=argparse.SUPPRESS)
    parser.add_argument("--scenes", nargs="+", choices=SCENES, default=["sphere"],
                        help="; ".join(f"{name}: {what}" for name, what in SCENES.items()) + " (default: sphere)")
    parser.add_argument("--changes", type=int, default=200,
                        help="of each: colour and view by a script, a slider and the view by the mouse (default: 200)")
    parser.add_argument("--models", nargs="+", choices=NAMES, default=NAMES, help="default: all")
    parser.add_argument("--json", metavar="FILE", help="where to keep every number, by scenes")
    chosen = parser.parse_args()
    found = {scene: measure(scene, chosen.changes, chosen.models) for scene in chosen.scenes}
    if chosen.json:
        pathlib.Path(chosen.json).write_text(json.dumps(found))
    for scene, settings in found.items():
        tell(scene, settings, found[chosen.scenes[0]], chosen)


def tell(scene, found, first, chosen):
    """Prints a scene's page. first: what was found of the scene that others are told beside."""
    width, height = found["size"]
    beside = f"; the last two are over {chosen.scenes[0]}'s" if found is not first else ""
    print(f"{SCENES[scene].capitalize()}, viewport of {width} x {height}, {chosen.changes} changes each; Solid is "
          f"Blender's redraw after the same{beside}.")
    print(f"{'dragged':<10}{'shown':<12}{'median ms':>10}{'/ Solid':>9}{'95 % ms':>9}{'/ Solid':>9}{'update ms':>11}"
          f"{'draw ms':>9}" + (f"{'median x':>10}{'95 % x':>8}" if beside else ""))
    for dragged in ("parameter", "slider", "view", "mouse"):
        if f"{dragged} solid" not in found:  # no model that was chosen has it
            continue
        solid = median_and_late(found[f"{dragged} solid"])[0]
        for setting, times in found.items():
            if not setting.startswith(dragged):
                continue
            median, late = median_and_late(times)
            main_thread = "".join(f"{statistics.median(times[name]):>{wide}.1f}" if times[name] else f"{'':>{wide}}"
                                  for name, wide in (("view_update", 11), ("view_draw", 9)))
            others = median_and_late(first[setting])
            print(f"{dragged:<10}{setting.split()[1]:<12}{median:>10.1f}{median / solid:>9.2f}{late:>9.1f}"
                  f"{late / solid:>9.2f}{main_thread}"
                  + (f"{median / others[0]:>10.2f}{late / others[1]:>8.2f}" if beside else ""))


def median_and_late(times):
    return statistics.median(times["wait"]), percentile(times["wait"], 0.95)


if __name__ == "__main__":
    main()

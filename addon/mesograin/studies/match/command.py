# The match of a .blend scene as a command: blender -b --factory-startup --python THIS -- SCENE PICTURE [OPTION ...]
"""Puts the add-on into a Blender without window, searches, writes match.json and the pictures."""

import shlex
import sys
from pathlib import Path

ADDON = Path(__file__).resolve().parents[2]


def _run(chosen, words):
    from mesograin.command_line.process import FAILED, OK, CommandError, open_scene, told

    scene, picture, asked = chosen
    native = open_scene(scene)

    from mesograin.studies.comparison.progress import Progress
    from mesograin.studies.comparison.results import OutputError
    from mesograin.studies.match import files, of_blender, run, target

    try:
        whole = of_blender.load(picture)
    except target.TargetError as error:
        raise CommandError(error) from error
    progress = Progress()
    with told(progress, OutputError, (native.Error, *run.SENTENCES)):
        results = run.match(asked, whole, progress, shlex.join(["./mesograin", "match", *words]))
    print(files.sentence(results))
    print(f"Results: {(Path(asked.out) / files.RESULTS).absolute()}", flush=True)
    return OK if results["converged"] else FAILED


if __name__ == "__main__":
    sys.path.insert(0, str(ADDON.parent))
    from mesograin.command_line import process
    from mesograin.studies.match import arguments

    process.main("match", arguments.parse, _run,
                 "Interrupted: what was rendered is kept, and the same command goes on from there.")

# The match of a scene in JSON as a command, without Blender: python3 THIS OPTION ...
"""Searches, writes match.json and the pictures; the exit code says how it went."""

import shlex
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3]))

from mesograin import __version__, native_module  # noqa: E402
from mesograin.studies.comparison.progress import Progress  # noqa: E402
from mesograin.studies.match import arguments, files, keeping, scenes, search, subject, target  # noqa: E402

DONE, UNENDED, USAGE, UNWRITABLE, INTERRUPTED = 0, 1, 2, 3, 130
PROVENANCE = "mesograin:provenance"


def main(words):
    scene, picture, asked = arguments.parse(words)
    try:
        asked.out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        return complain(f"The output folder {asked.out} cannot be made ({error.strerror}).", UNWRITABLE)
    progress = Progress()
    try:
        native = native_module.get()
        results = match(native, scene, picture, asked, progress, shlex.join(["./mesograin", "match", *words]))
    except native_module.Unavailable as error:
        return complain(error, USAGE)
    except (native.Error, subject.SubjectError, target.TargetError) as error:
        return complain(error, USAGE)
    except OSError as error:
        return complain(f"{asked.out} cannot be written ({error.strerror}).", UNWRITABLE)
    finally:
        progress.close()
    print(files.sentence(results))
    print(f"Results: {(asked.out / files.RESULTS).absolute()}")
    return DONE if results["converged"] else UNENDED


def match(native, scene, picture, asked, progress, command):
    """The dict of match.json. scene, picture: paths. asked: choices.Asked. Raises native.Error, SubjectError,
    TargetError or OSError."""
    whole = target.read(native, picture)
    matched, small, factor = scenes.read(native, scene, whole, asked.size, asked.samples)

    def mask(path, size):
        return target.bright(target.read(native, path), size)

    request = search.Request(
        asked.parameters, asked.model or matched.values["model"], asked.exposure == "free",
        keeping.keep(asked.masks, whole, small, factor, mask), asked.out / files.RENDERS)
    progress.plan(search.steps(request, search.guess(matched)), is_guess=True)
    found = search.search(native, matched, small, request, progress)
    results = files.describe(
        found, "unit", 1.0, asked.settings(), command=command, scene=scene.name,
        picture=picture.name, size=list(small.size), versions={"mesograin": __version__},
        device=native.device_info())
    files.write(native, asked.out, results, found, PROVENANCE)
    return results


def complain(sentence, code):
    print(f"match: {sentence}", file=sys.stderr)
    return code


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except KeyboardInterrupt:
        sys.exit(complain("Interrupted: what was rendered is kept, and the same command goes on from there.",
                          INTERRUPTED))

# The command line of `match`, readable without Blender.
"""See `parse`."""

import argparse
from pathlib import Path

from ...command_line import parser as shared
from ...command_line.values import positive
from ..comparison import mask_names
from .choices import (COEFFICIENTS, CORRECTIONS, EXPOSURES, MODELS, MOST_CORRECTIONS, PARAMETERS, REFERENCES,
                      Asked)


def build():
    """The parser, for --help without Blender."""
    parser = shared.Parser(
        prog="./mesograin match",
        usage="./mesograin match SCENE PICTURE [options]",
        description=(
            "Finds the sigma_a and sigma_s (and g) of a scene's grains by which its picture is nearest to a given one:"
            " a render or a photograph of grains of known size, with the scene's camera and lights."
        ),
        epilog=(
            "Exit codes: 0 found, 1 the search did not come to its end (the best so far is written), 2 bad arguments,"
            " scene or picture, 3 the output folder cannot be written, 130 interrupted. The same command goes on where"
            " it was stopped."
        ),
    )
    parser.add_argument("scene", type=Path, metavar="SCENE",
                        help="a .blend file, or a scene in JSON, whose translucent grains all are matched")
    parser.add_argument("picture", type=Path, metavar="PICTURE",
                        help="an EXR file of linear radiance; with a .blend scene also what Blender reads, in sRGB")
    parser.add_argument("--material", metavar="NAME",
                        help="of the grains to match (default: the only translucent one; .blend alone)")
    parser.add_argument("--parameters", type=_parameters, default=COEFFICIENTS, metavar="LIST",
                        help=f"of {','.join(PARAMETERS)}, what is searched for; the rest stays as the material says"
                        f" (default: {','.join(COEFFICIENTS)})")
    parser.add_argument("--model", choices=MODELS, default=None,
                        help="that draws the grains (default: the material's own; auto is transport)")
    parser.add_argument("--reference", choices=REFERENCES, default=None, metavar="KIND",
                        help="what Cycles solved where the picture is its own (docs/comparing.md): "
                        f"{', '.join(REFERENCES)} (default: what the material's boundary says; .blend alone)")
    parser.add_argument("--exposure", choices=EXPOSURES, default=EXPOSURES[0],
                        help="whether the picture is as bright as the scene, or up to a factor that is found, too"
                        " (default: known)")
    parser.add_argument("--mask", action="append", type=_mask, default=[], dest="masks", metavar="MASK",
                        help="crop:LEFT,TOP,RIGHT,BOTTOM in pixels of the picture, or a picture of its size whose"
                        " bright pixels count; may be repeated")
    parser.add_argument("--size", type=positive, default=Asked.size, metavar="N",
                        help=f"longer side of what is drawn and compared, in pixels (default: {Asked.size})")
    parser.add_argument("--samples", type=positive, default=Asked.samples, metavar="N",
                        help=f"of each pixel of each picture (default: {Asked.samples})")
    parser.add_argument("--corrections", type=_count, default=None, metavar="N",
                        help="how often, at most, Cycles renders what was found, to correct our model by what it is off"
                        f" there; needs --reference (default: {CORRECTIONS} with it)")
    parser.add_argument("--traced-samples", type=positive, default=Asked.traced_samples, metavar="N",
                        help=f"of each pixel of these (default: {Asked.traced_samples})")
    parser.add_argument("--out", type=Path, default=Path("match"), metavar="DIR",
                        help="folder for match.json and the pictures (default: match)")
    return parser


def parse(words):
    """(scene's path, picture's path, choices.Asked) of the command line. Raises SystemExit(2) after one sentence on
    standard error."""
    parser = build()
    chosen = parser.parse_args(words)
    for what in ("scene", "picture"):
        if not getattr(chosen, what).is_file():
            parser.error(f"there is no {what} '{getattr(chosen, what)}'")
    if is_json(chosen.scene):
        for name in ("material", "reference"):
            if getattr(chosen, name) is not None:
                parser.error(f"--{name} needs a .blend scene; '{chosen.scene}' is JSON")
        masks = [path for kind, path in chosen.masks if kind == "file"]
        others = [path for path in (chosen.picture, *masks) if path.suffix.lower() != ".exr"]
        if others:
            parser.error(f"with a scene in JSON pictures are EXR files; '{others[0]}' came")
    if chosen.corrections and chosen.reference is None:
        parser.error("--corrections needs --reference, by which Cycles is to render")
    if chosen.corrections is None:
        chosen.corrections = CORRECTIONS if chosen.reference else 0
    asked = {**vars(chosen), "masks": tuple(chosen.masks)}
    return asked.pop("scene"), asked.pop("picture"), Asked(**asked)


def is_json(scene):
    """Whether a scene needs no Blender."""
    return scene.suffix.lower() == ".json"


def _parameters(text):
    names = tuple(dict.fromkeys(text.split(",")))
    if not all(name in PARAMETERS for name in names):
        raise argparse.ArgumentTypeError(f"names of {', '.join(PARAMETERS)} with commas are needed, '{text}' came")
    return names


def _count(text):
    if not text.isdigit() or int(text) > MOST_CORRECTIONS:
        raise argparse.ArgumentTypeError(f"a whole number from 0 to {MOST_CORRECTIONS} is needed, '{text}' came")
    return int(text)


def _mask(text):
    """('crop', four numbers) or ('file', path)."""
    if text.startswith("crop:"):
        return mask_names.parse(text)
    path = Path(text)
    if not path.is_file():
        raise argparse.ArgumentTypeError(f"crop:LEFT,TOP,RIGHT,BOTTOM or a picture is needed, '{text}' came")
    return "file", path


if __name__ == "__main__":
    build().print_help()

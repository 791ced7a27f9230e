# The command line of `bake`, readable without Blender.
"""See `parse`."""

import argparse
import re
from pathlib import Path

from ...command_line import parser as shared
from ...command_line.values import positive
from ...schema.models import CHOICES
from ..comparison.arguments import REFERENCES
from .choices import (DEFAULT_COMPONENTS, DEFAULT_MARGIN, FEWEST_COMPONENTS, LARGEST_COMPONENTS, LARGEST_MARGIN,
                      LARGEST_SIDE, SAMPLES, SAMPLES_OF_A_DIRECTION, VIEW_FROM)


def build():
    """The parser, for --help without Blender."""
    parser = shared.Parser(
        prog="./mesograin bake",
        usage="./mesograin bake SCENE.blend -o OUT.exr [options]",
        description="Bakes an object's surface to an EXR texture at its UVs, and Cycles' beside it with --compare.",
        epilog="Exit codes: 0 written, 1 it could not be baked, 2 bad arguments or scene, 3 the output cannot be"
        " written, 130 interrupted. Files appear complete or not at all.",
    )
    parser.add_argument("scene", type=Path, metavar="SCENE.blend", help="the scene")
    parser.add_argument("-o", "--output", type=_exr, required=True, metavar="OUT.exr", help="texture to write")
    parser.add_argument("--object", default=None, metavar="NAME",
                        help="what to bake (default: the active object, or the only one)")
    parser.add_argument("--model", choices=tuple(CHOICES), default=None, metavar="MODEL",
                        help=f"one of {', '.join(CHOICES)} (default: the material's)")
    parser.add_argument("--size", type=_size, default=(1024, 1024), metavar="SIDE|WxH",
                        help="texels (default: 1024, square)")
    parser.add_argument("--samples", type=positive, default=None, metavar="N",
                        help=f"samples a texel (default: {SAMPLES}; with --relightable"
                        f" {SAMPLES_OF_A_DIRECTION} for each direction)")
    parser.add_argument("--view-from", choices=VIEW_FROM, default=VIEW_FROM[0], metavar="WHERE",
                        help=f"what looks at the surface: {' or '.join(VIEW_FROM)} (default: the first)")
    parser.add_argument("--margin", type=_margin, default=DEFAULT_MARGIN, metavar="N",
                        help="texels by which what is baked reaches beyond the UVs (default: 16)")
    parser.add_argument("--half", action="store_true", help="16-bit instead of 32-bit floats")
    shared.add_settings(parser, "")
    shared.add_exchange(parser)
    parser.add_argument("--relightable", action="store_true",
                        help="for light from anywhere, not the scene's: components as layers of OUT.exr, the same as"
                        " OUT.atlas.exr, OUT.lobes.exr, a node group in OUT.blend, a shader's recipe OUT.glsl, and the"
                        " error over 64 directions in OUT.json")
    parser.add_argument("--components", type=_components, default=None, metavar="N",
                        help=f"with --relightable: textures, {FEWEST_COMPONENTS} to {LARGEST_COMPONENTS}"
                        f" (default: {DEFAULT_COMPONENTS})")
    parser.add_argument("--compare", action="store_true",
                        help="also bakes what can be compared with Cycles, without a margin: OUT.mesograin.exr,"
                        " OUT.cycles.exr, OUT.error.exr, PNGs, and numbers in OUT.json")
    parser.add_argument("--reference", choices=REFERENCES, default=None, metavar="KIND",
                        help=f"with --compare: what Cycles solves, of {', '.join(REFERENCES)} (default: the model's)")
    parser.add_argument("--reference-samples", type=positive, default=None, metavar="N",
                        help="with --compare: Cycles samples a texel for each of two seeds (default: 64, volumes 128)")
    return parser


def parse(words):
    """argparse.Namespace of the command line after `--`. Raises SystemExit(2) after one sentence on standard error."""
    parser = build()
    chosen = parser.choose(words)
    if not chosen.compare and (chosen.reference or chosen.reference_samples):
        parser.error("--reference and --reference-samples need --compare")
    if chosen.components and not chosen.relightable:
        parser.error("--components needs --relightable")
    if chosen.relightable and (chosen.compare or chosen.view_from != VIEW_FROM[0]):
        parser.error("--relightable is neither compared nor baked for a camera: leave out --compare and --view-from")
    chosen.samples = chosen.samples or (SAMPLES_OF_A_DIRECTION if chosen.relightable else SAMPLES)
    chosen.components = chosen.components or DEFAULT_COMPONENTS
    return chosen


def _exr(text):
    path = Path(text)
    if path.suffix.lower() != ".exr":
        raise argparse.ArgumentTypeError(f"the output is OpenEXR and must end in .exr, '{text}' came")
    return path


def _size(text):
    found = re.fullmatch(r"(\d{1,5})(?:[xX](\d{1,5}))?", text)
    size = tuple(int(side or found[1]) for side in found.groups()) if found else (0, 0)
    if not all(1 <= side <= LARGEST_SIDE for side in size):
        raise argparse.ArgumentTypeError(f"SIDE or WIDTHxHEIGHT of 1 to {LARGEST_SIDE} texels is needed, '{text}' came")
    return size


def _components(text):
    if not text.isdigit() or not FEWEST_COMPONENTS <= int(text) <= LARGEST_COMPONENTS:
        raise argparse.ArgumentTypeError(
            f"a whole number from {FEWEST_COMPONENTS} to {LARGEST_COMPONENTS} is needed, '{text}' came")
    return int(text)


def _margin(text):
    if not text.isdigit() or int(text) > LARGEST_MARGIN:
        raise argparse.ArgumentTypeError(f"a whole number from 0 to {LARGEST_MARGIN} is needed, '{text}' came")
    return int(text)


if __name__ == "__main__":
    build().print_help()

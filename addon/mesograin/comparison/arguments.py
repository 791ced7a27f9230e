# The command line of `compare`, readable without Blender.
"""See `parse`."""

import argparse
import re
from pathlib import Path

from ..cycles import kinds
from . import mask_names

MODELS = ("lambert", "conductor", "model_1", "model_2", "model_3")
REFERENCES = tuple(kinds.KINDS)
DEFAULT_MODELS = ("lambert", "conductor", "model_1", "model_2", "model_3")
SETTABLE = {
    "reflectance": 3,
    "sigma_a": 3,
    "sigma_s": 3,
    "g": 1,
    "eta": 1,
    "roughness": 1,
    "scale": 1,
    "profile": 0,
}
"""Parameters that --set may change, and how many numbers each takes; 0 for a word."""
MOST_SEEDS = 64
"""How many seeds of a reference --until may lead to, if nothing else is said."""


class Parser(argparse.ArgumentParser):
    """Says what is wrong in one sentence."""

    def error(self, message):
        self.exit(2, f"{self.prog.split()[-1]}: {message}; see --help.\n")


def build():
    """The parser, for --help without Blender."""
    parser = Parser(
        prog="mesograin compare",
        usage="mesograin compare [SCENE.blend] [options]",
        description=(
            "Renders every model and the Cycles reference that means the same, and writes pictures, numbers and a"
            " report."
        ),
        epilog=(
            "Exit codes: 0 all compared, 1 a case failed (the others are written), 2 bad arguments or scene, "
            "3 the output folder cannot be written, 130 interrupted. A second run finds its references in the cache."
        ),
    )
    parser.add_argument("scene", nargs="?", type=Path, default=None, metavar="SCENE.blend", help="the scene to compare")
    parser.add_argument(
        "--models",
        nargs="+",
        choices=MODELS,
        default=DEFAULT_MODELS,
        metavar="MODEL",
        help=f"models to compare, of {', '.join(MODELS)} (default: {' '.join(DEFAULT_MODELS)})",
    )
    parser.add_argument(
        "--references",
        nargs="+",
        choices=REFERENCES,
        default=None,
        metavar="KIND",
        help=(
            f"kinds of reference, of {', '.join(REFERENCES)}; each model is compared with those that answer it "
            "(default: diffuse for lambert, glossy for conductor, volume_index_matched for the others)"
        ),
    )
    parser.add_argument(
        "--out",
        type=Path,
        default=Path("comparison"),
        metavar="DIR",
        help="folder for results.json, results.csv, report.html and the pictures (default: comparison)",
    )
    parser.add_argument(
        "--size", type=_size, default=None, metavar="WxH", help="picture size in pixels (default: the scene's)"
    )
    parser.add_argument(
        "--samples", type=positive, default=64, metavar="N", help="samples a pixel on our side (default: 64)"
    )
    parser.add_argument(
        "--reference-samples",
        type=positive,
        default=None,
        metavar="N",
        help="samples a pixel for each seed of the reference (default: 64 for surfaces, 128 for volumes, 1024 for"
        " volume_dielectric, 256 for photon)",
    )
    parser.add_argument(
        "--seeds",
        type=positive,
        default=2,
        metavar="K",
        help="independent renders of each reference, whose spread tells its noise; more are added to those in the cache"
        " (default: 2)",
    )
    parser.add_argument(
        "--until",
        type=_fraction,
        default=None,
        metavar="FRACTION",
        help="add seeds until the reference's noise is at most this fraction of the measured error, such as 0.2",
    )
    parser.add_argument(
        "--most-seeds",
        type=positive,
        default=MOST_SEEDS,
        metavar="K",
        help=f"how many seeds --until may lead to (default: {MOST_SEEDS})",
    )
    parser.add_argument(
        "--mask",
        nargs="+",
        type=_mask,
        default=[],
        dest="masks",
        metavar="NAME",
        help=(
            "leave pixels out of the numbers, one mask after another: silhouette:PIXELS (shrunk by so many, default 2),"
            " crop:LEFT,TOP,RIGHT,BOTTOM, mean_deviation[:DEVIATIONS], otsu[:MEDIAN_SIZE]; what each took away and the"
            " unfiltered numbers stand beside"
        ),
    )
    parser.add_argument(
        "--set",
        action="append",
        type=setting,
        default=[],
        dest="settings",
        metavar="NAME=VALUE",
        help=(
            "a material parameter for every material, on both sides: "
            f"{', '.join(SETTABLE)}; RGB as one number or three with commas; may be repeated"
        ),
    )
    parser.add_argument(
        "--frames", type=positive, default=9, metavar="N", help="frames timed for frame_ms (default: 9)"
    )
    parser.add_argument(
        "--cache",
        type=Path,
        default=None,
        metavar="DIR",
        help="folder of rendered references (default: MESOGRAIN_CACHE, or mesograin/references in the user's cache)",
    )
    parser.add_argument(
        "--cache-limit",
        type=_bytes,
        default=None,
        metavar="SIZE",
        help="bytes that it may take, with an optional K, M or G (default: MESOGRAIN_CACHE_LIMIT, or 2G)",
    )
    parser.add_argument("--clear-cache", action="store_true", help="empty the reference cache and do nothing else")
    parser.add_argument("--no-report", action="store_true", help="write no report.html")
    return parser


def parse(words):
    """argparse.Namespace of the command line after `--`. Raises SystemExit(2) after one sentence on standard error."""
    parser = build()
    chosen = parser.parse_args(words)
    chosen.settings = dict(chosen.settings)
    if chosen.scene and not chosen.scene.is_file():
        parser.error(f"there is no scene '{chosen.scene}'")
    return chosen


def positive(text):
    """The number in a word of the command line."""
    if not text.isdigit() or not 1 <= int(text) <= 1 << 20:
        raise argparse.ArgumentTypeError(f"a whole number from 1 to {1 << 20} is needed, '{text}' came")
    return int(text)


def _mask(text):
    try:
        return mask_names.parse(text)
    except mask_names.MaskError as error:
        raise argparse.ArgumentTypeError(str(error)) from error


def _fraction(text):
    try:
        fraction = float(text)
    except ValueError:
        fraction = 0.0
    if not 0.0 < fraction <= 1.0:
        raise argparse.ArgumentTypeError(f"a number above 0 and up to 1 is needed, '{text}' came")
    return fraction


def _size(text):
    found = re.fullmatch(r"(\d{1,5})[xX](\d{1,5})", text)
    if not found or not all(8 <= int(side) <= 16384 for side in found.groups()):
        raise argparse.ArgumentTypeError(f"WIDTHxHEIGHT with 8 to 16384 pixels a side is needed, '{text}' came")
    return tuple(int(side) for side in found.groups())


def _bytes(text):
    found = re.fullmatch(r"(\d+)([KMG]?)", text, re.IGNORECASE)
    if not found:
        raise argparse.ArgumentTypeError(f"a number of bytes such as 500M is needed, '{text}' came")
    return int(found[1]) * 1024 ** " KMG".index(found[2].upper() or " ")


def setting(text):
    """(name, value) of a word NAME=VALUE: a number, three, or a word, as SETTABLE has it."""
    name, equals, value = text.partition("=")
    if not equals or name not in SETTABLE:
        hint = " (the reference chooses it)" if name in ("boundary", "masking") else ""
        raise argparse.ArgumentTypeError(f"NAME=VALUE with one of {', '.join(SETTABLE)} is needed, '{text}' came{hint}")
    count = SETTABLE[name]
    if count == 0:
        return name, value
    try:
        numbers = tuple(float(number) for number in value.split(","))
    except ValueError:
        numbers = ()
    if count == 3 and len(numbers) == 1:
        numbers *= 3
    if len(numbers) != count:
        raise argparse.ArgumentTypeError(
            f"{name} takes {'one number or three' if count == 3 else 'one number'}, '{value}' came"
        )
    return name, numbers if count == 3 else numbers[0]


if __name__ == "__main__":
    build().print_help()

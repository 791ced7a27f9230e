# The command line of `compare`, readable without Blender.
"""See `parse`."""

from pathlib import Path

from ...command_line import parser as shared
from ...command_line.values import fraction, picture_size, positive
from ...cycles import kinds
from ...schema import models
from . import mask_names

MODELS = tuple(name for name in models.CHOICES if kinds.default_kind(name))
REFERENCES = tuple(kinds.KINDS)
# Transport takes seconds for each case before its first picture.
DEFAULT_MODELS = tuple(name for name in models.NAMES if name in MODELS and not models.MODELS[name].mesh)
MOST_SEEDS = 64
"""How many seeds of a reference --until may lead to, if nothing else is said."""


def build():
    """The parser, for --help without Blender."""
    parser = shared.Parser(
        prog="./mesograin compare",
        usage="./mesograin compare [SCENE.blend] [options]",
        description=(
            "Renders every model and the Cycles reference that means the same, and writes pictures, numbers and a"
            " report."
        ),
        epilog=(
            "Exit codes: 0 all compared, 1 a case failed (the others are written), 2 bad arguments or scene, "
            "3 the output folder cannot be written, 130 interrupted. A second run finds its references in the cache."
        ),
    )
    shared.add_scene(parser, "compare")
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
            "(default: diffuse for lambert, glossy for conductor, volume_index_matched for the others; of a part, those"
            " that have it)"
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
        "--size", type=picture_size, default=None, metavar="WxH", help="picture size in pixels (default: the scene's)"
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
        " volume_dielectric, 256 for photon and photon_scene)",
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
        type=fraction,
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
        "--part",
        choices=kinds.PARTS,
        default=None,
        metavar="PART",
        help=(
            "compare a part of the light alone: specular, what the surface reflects, or subsurface, what was inside"
            " (default: the whole)"
        ),
    )
    parser.add_argument(
        "--controls",
        action="store_true",
        help=(
            "also test the significance test on each case: the reference's own renderer in our place, with the same"
            " material (must not differ) and with a wrong one such as twice the scale (must); three times the time"
        ),
    )
    parser.add_argument(
        "--mask",
        nargs="+",
        type=mask_names.parse,
        default=[],
        dest="masks",
        metavar="NAME",
        help=(
            "leave pixels out of the numbers, one mask after another: silhouette:PIXELS (shrunk by so many, default 2),"
            " crop:LEFT,TOP,RIGHT,BOTTOM, mean_deviation[:DEVIATIONS], otsu[:MEDIAN_SIZE]; what each took away and the"
            " unfiltered numbers stand beside"
        ),
    )
    shared.add_settings(parser, " for every material, on both sides")
    parser.add_argument(
        "--frames", type=positive, default=9, metavar="N", help="frames timed for frame_ms (default: 9)"
    )
    shared.add_exchange(parser)
    shared.add_cache(parser)
    parser.add_argument("--clear-cache", action="store_true", help="empty the reference cache and do nothing else")
    parser.add_argument("--no-report", action="store_true", help="write no report.html")
    return parser


def parse(words):
    """argparse.Namespace of the command line after `--`. Raises SystemExit(2) after one sentence on standard error."""
    parser = build()
    chosen = parser.choose(words)
    for kind in chosen.references or ():
        if not kinds.has(kind, chosen.part):
            parser.error(kinds.missing_part(kind, chosen.part))
    if chosen.controls and chosen.seeds < 2:
        parser.error("--controls needs --seeds 2 or more, since one does not tell its noise")
    return chosen


if __name__ == "__main__":
    build().print_help()

# The command line of `trade`, readable without Blender.
"""See `parse`."""

from pathlib import Path

from ...command_line import parser as shared
from ...command_line.values import picture_size, positive
from ...cycles.kinds import KINDS
from ...schema.models import MODELS
REFERENCES = tuple(KINDS)
LEAST_CONVERGED = 512
"""Samples a pixel of the converged render, unless its kind needs more."""


def build():
    """The parser, for --help without Blender."""
    parser = shared.Parser(
        prog="./mesograin trade",
        usage="./mesograin trade [SCENE.blend] [options]",
        description=(
            "Measures error against time: every model at several sample counts, and Cycles itself (or the photon"
            " tracer) at rising samples, all against one converged render; draws the Pareto front."
        ),
        epilog=(
            "Exit codes: 0 measured, 1 something failed (the rest is written), 2 bad arguments or scene, 3 the output "
            "folder cannot be written, 130 interrupted. The same command goes on where it was stopped."
        ),
    )
    shared.add_scene(parser, "measure")
    parser.add_argument(
        "--reference",
        choices=REFERENCES,
        default="volume_index_matched",
        metavar="KIND",
        help=f"what the models are measured against, of {', '.join(REFERENCES)} (default: volume_index_matched)",
    )
    parser.add_argument(
        "--models",
        nargs="+",
        default=None,
        metavar="MODEL",
        help="models to measure (default: all that answer the reference)",
    )
    parser.add_argument(
        "--samples",
        nargs="+",
        type=positive,
        default=(1, 4, 16, 64),
        metavar="N",
        help="samples a pixel on our side (default: 1 4 16 64)",
    )
    parser.add_argument(
        "--taps",
        nargs="+",
        type=positive,
        default=(4, 16, 64),
        metavar="N",
        help="samples of the lit surface that model 3 takes for each of those (default: 4 16 64)",
    )
    parser.add_argument(
        "--reference-samples",
        type=positive,
        default=None,
        metavar="N",
        help="samples a pixel of each of the two seeds of the converged render (default: 512; volume_dielectric 1024)",
    )
    parser.add_argument(
        "--traced-samples",
        nargs="+",
        type=positive,
        default=None,
        metavar="N",
        help="samples a pixel of Cycles' renders to measure, or of the photon tracer's (default: 1 2 4 ... to a quarter"
        " of the converged one)",
    )
    parser.add_argument(
        "--out", type=Path, default=Path("trade"), metavar="DIR", help="folder for what is written (default: trade)"
    )
    parser.add_argument(
        "--size", type=picture_size, default=(128, 128), metavar="WxH", help="picture size in pixels (default: 128x128)"
    )
    parser.add_argument(
        "--frames", type=positive, default=25, metavar="N", help="frames whose median is the time of one (default: 25)"
    )
    shared.add_settings(parser, " for every material, on both sides")
    shared.add_exchange(parser)
    shared.add_cache(parser)
    return parser


def parse(words):
    """argparse.Namespace of the command line after `--`. Raises SystemExit(2) after one sentence on standard error."""
    parser = build()
    chosen = parser.choose(words)
    answered = KINDS[chosen.reference].models
    chosen.models = tuple(dict.fromkeys(chosen.models or [model for model in answered if model in MODELS]))
    for model in chosen.models:
        if model not in answered:
            parser.error(f"'{model}' is not answered by {chosen.reference}; allowed are {', '.join(answered)}")
    for name in ("samples", "taps"):
        setattr(chosen, name, tuple(sorted(set(getattr(chosen, name)))))
    chosen.reference_samples = chosen.reference_samples or max(LEAST_CONVERGED, KINDS[chosen.reference].samples)
    chosen.traced_samples = tuple(sorted(set(chosen.traced_samples or rising(chosen.reference_samples))))
    if chosen.traced_samples[-1] > chosen.reference_samples:
        parser.error(
            f"--traced-samples must not exceed the converged render's {chosen.reference_samples} samples;"
            f" got {chosen.traced_samples[-1]}"
        )
    return chosen


def rising(converged):
    """1, 2, 4, ... up to a quarter of the converged render's samples: beyond, the reference's own noise drowns them."""
    counts = [1]
    while 2 * counts[-1] <= converged // 4:
        counts.append(2 * counts[-1])
    return tuple(counts)


if __name__ == "__main__":
    build().print_help()

# The plots of the report as SVG text that takes its colours and its type from the page.
"""Each function returns SVG; colours are the page's custom properties, so that a plot suits light and dark alike."""

import io
import re

import matplotlib
import numpy
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

# Stand-ins that the page's own colours replace.
INK, QUIET, GRID, OURS, THEIRS = "#010203", "#010204", "#010205", "#010206", "#010207"
_PROPERTIES = {INK: "--ink", QUIET: "--quiet", GRID: "--line", OURS: "--ours", THEIRS: "--theirs"}

_STYLE = {
    "svg.fonttype": "none",
    "font.family": "sans-serif",
    "font.size": 9,
    "axes.edgecolor": GRID,
    "axes.labelcolor": QUIET,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.8,
    "grid.color": GRID,
    "grid.linewidth": 0.6,
    "text.color": INK,
    "xtick.color": QUIET,
    "ytick.color": QUIET,
    "xtick.major.size": 0,
    "ytick.major.size": 0,
    "xtick.minor.size": 0,
    "ytick.minor.size": 0,
    "svg.hashsalt": "mesograin",
}


def trade(cases):
    """Error against milliseconds of a frame; the bar reaches down to what the reference's noise alone would score."""
    with matplotlib.rc_context(_STYLE):
        figure, axes = _figure(9.0, 2.9)
        axes.set_xscale("log")
        axes.set_yscale("log")
        for case in cases:
            error, floor = case["metrics"]["relative_l1"], case["noise_floor"]["relative_l1"]
            if not error:
                continue
            if floor:
                axes.plot([case["frame_ms"]] * 2, [min(floor, error), error], color=OURS, linewidth=1.0, alpha=0.45)
                axes.plot([case["frame_ms"]], [floor], marker="_", color=OURS, markersize=8, alpha=0.7)
            axes.plot([case["frame_ms"]], [error], marker="o", color=OURS, markersize=6)
            axes.annotate(
                case["name"], (case["frame_ms"], error), (8, 0), textcoords="offset points", va="center", fontsize=8.5
            )
        axes.set_xlabel("milliseconds a frame")
        axes.set_ylabel("relative L1")
        _log_axis(axes.xaxis, [case["frame_ms"] for case in cases], 1.6, lambda value, _: f"{value:g}")
        shares = [
            value
            for case in cases
            for value in (case["metrics"]["relative_l1"], case["noise_floor"]["relative_l1"])
            if value
        ]
        _log_axis(axes.yaxis, shares, 2.0, lambda value, _: f"{100 * value:g} %", steps=(1, 3))
        axes.grid(True, which="major")
        return _svg(figure)


def profile(model, reference):
    """Radiance along the line across the picture on which the reference changes most, averaged over a band of 5
    pixels."""
    line = _steepest_line(reference)
    if line is None:
        return ""
    theirs, ours = (_sample_band(pixels, line) for pixels in (reference, model))
    along = numpy.linspace(0.0, 1.0, len(theirs))
    with matplotlib.rc_context(_STYLE):
        figure, axes = _figure(4.0, 2.1)
        axes.plot(along, theirs, color=THEIRS, linewidth=3.0, alpha=0.55, solid_capstyle="round", label="reference")
        axes.plot(along, ours, color=OURS, linewidth=1.3, label="model")
        axes.set_xlabel("across the picture, from dark to bright")
        axes.set_ylabel("radiance")
        axes.set_xlim(0.0, 1.0)
        axes.set_ylim(bottom=0.0)
        axes.set_xticks([])
        axes.grid(True, axis="y")
        axes.legend(frameon=False, fontsize=8.5, loc="upper left")
        return _svg(figure)


def histogram(relative, mask):
    """How the signed relative error is distributed over the masked pixels."""
    values = 100.0 * relative[mask]
    values = values[numpy.isfinite(values)]
    if not values.size:
        return ""
    reach = max(1.5 * float(numpy.percentile(numpy.abs(values), 95.0)), 0.05)
    with matplotlib.rc_context(_STYLE):
        figure, axes = _figure(4.0, 2.1)
        axes.hist(
            numpy.clip(values, -reach, reach), bins=61, range=(-reach, reach), color=OURS, alpha=0.75, linewidth=0
        )
        axes.axvline(0.0, color=QUIET, linewidth=0.8)
        axes.set_xlabel("(model − reference) / (reference + 0.01), per cent")
        axes.set_ylabel("pixels")
        axes.set_xlim(-reach, reach)
        axes.grid(True, axis="y")
        return _svg(figure)


def _log_axis(axis, values, margin, write, steps=(1, 2, 3, 5, 7)):
    """Limits a logarithmic axis to the values and a margin, with ticks at `steps` of each decade."""
    if not values:
        return
    low, high = min(values) / margin, max(values) * margin
    if high < 4.0 * low:
        low, high = low / 2.0, high * 2.0
    decades = range(int(numpy.floor(numpy.log10(low))), int(numpy.ceil(numpy.log10(high))) + 1)
    axis.set_major_locator(FixedLocator([step * 10.0**decade for decade in decades for step in steps]))
    axis.set_major_formatter(FuncFormatter(write))
    axis.set_minor_locator(NullLocator())
    (axis.axes.set_xlim if axis.axis_name == "x" else axis.axes.set_ylim)(low, high)


def _figure(width, height):
    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasSVG(figure)
    figure.patch.set_alpha(0.0)
    axes = figure.add_subplot()
    axes.patch.set_alpha(0.0)
    axes.set_axisbelow(True)
    return figure, axes


def _svg(figure):
    text = io.StringIO()
    figure.savefig(text, format="svg", metadata={"Date": None, "Creator": None, "Format": None, "Type": None})
    svg = text.getvalue()
    svg = svg[svg.index("<svg"):]
    for stand_in, name in _PROPERTIES.items():
        svg = svg.replace(stand_in, f"var({name})")
    # Type and size are the page's.
    svg = re.sub(r"font: ([\d.]+)px [^;\"]*", r"font: \1px var(--sans)", svg)
    return re.sub(r'<svg ([^>]*?)width="[\d.]+pt" height="[\d.]+pt"', r"<svg \1", svg, count=1)


def _steepest_line(reference):
    """((x, y) of one end, (x, y) of the other), through the middle of what is covered; None if nothing is."""
    covered = reference[..., 3] > 0.5
    if covered.sum() < 16:
        return None
    y, x = numpy.nonzero(covered)
    light = numpy.maximum(numpy.nan_to_num(reference[..., :3].mean(axis=-1)[covered]), 0.0) + 1e-12
    middle = numpy.array([x.mean(), y.mean()])
    bright = numpy.array([numpy.average(x, weights=light), numpy.average(y, weights=light)])
    direction = bright - middle
    length = numpy.hypot(*direction)
    direction = direction / length if length > 1e-3 else numpy.array([1.0, 0.0])
    reach = numpy.stack([x, y], axis=-1) - middle
    near = numpy.abs(reach @ numpy.array([-direction[1], direction[0]])) < 1.0
    along = (reach @ direction)[near]
    return middle + along.min() * direction, middle + along.max() * direction


def _sample_band(pixels, line, half_width=2):
    """Mean of the channels along a line of pixel positions and its neighbours, nearest pixel."""
    start, end = line
    count = max(int(numpy.hypot(*(end - start))), 2)
    at = start + numpy.linspace(0.0, 1.0, count)[:, None] * (end - start)
    aside = numpy.array([-(end - start)[1], (end - start)[0]]) / max(numpy.hypot(*(end - start)), 1e-9)
    height, width = pixels.shape[:2]
    bands = []
    for offset in range(-half_width, half_width + 1):
        x, y = numpy.rint(at + offset * aside).astype(int).T
        bands.append(pixels[numpy.clip(y, 0, height - 1), numpy.clip(x, 0, width - 1), :3].mean(axis=-1))
    return numpy.nanmean(bands, axis=0)

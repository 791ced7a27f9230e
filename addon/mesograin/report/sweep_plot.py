# The plots of a sweep: a metric over a parameter that is a number, a line for everything else that varies.
"""See `over` and `numeric_axes`."""

import math

from matplotlib.ticker import FixedLocator, FuncFormatter
from matplotlib.transforms import ScaledTranslation

from ..cycles.wording import LABELS
from .plots import log_axis, new_figure, percent

METRICS = {
    "relative_l1": "relative L1:  Σ|i − r| / Σr",
    "rse_mean": "mean RSE:  (i − r)² / (r² + 0.01)",
    "bias": "bias:  Σi / Σr",
}
UNITS = {
    "sigma_a": "σa, per scene unit",
    "sigma_s": "σs, per scene unit",
    "eta": "η",
    "roughness": "roughness (GGX α)",
    "scale": "scale (multiplies σa and σs)",
    "reflectance": "reflectance",
}
MARKERS = ("o", "s", "^", "D", "v", "P", "X")
DASHES = ("-", (0, (5, 2)), (0, (1, 1.5)), (0, (5, 1.5, 1, 1.5)))


def numeric_axes(results):
    """Those of the sweep's axes that have at least two numbers. results: of a sweep's results.json."""
    return [axis for axis in results["axes"] if len({_number(row, axis) for row in results["rows"]} - {None}) > 1]


def over(results, axis, metric):
    """A plot of one of METRICS over an axis; the error bar of a point is the noise floor of its reference, where the
    metric has one."""

    def draw(palette):
        lines = _lines(results, axis, metric)
        if not lines:
            return None
        figure, axes = new_figure(8.2, 4.2)
        colours = (palette.ours, palette.theirs, palette.second, palette.third, palette.ink)
        for number, (label, line) in enumerate(lines.items()):
            x, y, floor = zip(*sorted(line), strict=True)
            drawn, caps, bars = axes.errorbar(
                x, y, yerr=floor if any(floor) else None, label=label, color=colours[number % len(colours)],
                marker=MARKERS[number % len(MARKERS)], linestyle=DASHES[number // len(colours) % len(DASHES)],
                markersize=4, linewidth=1.3, elinewidth=0.8, capsize=2,
            )
            # Side by side, because all lines have their points at the same values.
            aside = (number - 0.5 * (len(lines) - 1)) * min(4.0, 24.0 / len(lines))
            shifted = axes.transData + ScaledTranslation(aside / 72.0, 0.0, figure.dpi_scale_trans)
            for artist in (drawn, *caps, *bars):
                artist.set_transform(shifted)
        numbers = sorted({point[0] for line in lines.values() for point in line})
        if min(numbers) > 0 and max(numbers) / min(numbers) >= 20:
            axes.set_xscale("log")
            log_axis(axes.xaxis, numbers, 1.2, lambda value, _: f"{value:g}")
        if _far_apart(numbers, axes.get_xscale() == "log"):
            axes.xaxis.set_major_locator(FixedLocator(numbers))
            axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        if metric == "relative_l1":
            axes.yaxis.set_major_formatter(FuncFormatter(percent))
        if metric == "bias":
            axes.axhline(1.0, color=palette.quiet, linewidth=0.8, zorder=0)
        else:
            axes.set_ylim(bottom=0.0)
        axes.set_xlabel(UNITS.get(axis, axis))
        axes.set_ylabel(METRICS[metric])
        axes.set_title(results["title"], fontsize=10, color=palette.ink)
        axes.grid(True)
        axes.legend(frameon=False, fontsize=8, loc="upper left", bbox_to_anchor=(1.0, 1.0))
        return figure

    return draw


def _far_apart(numbers, logarithmic):
    """Whether values of an axis can all be its ticks."""
    places = [math.log(number) for number in numbers] if logarithmic else numbers
    gaps = [after - before for before, after in zip(places, places[1:])]
    return bool(gaps) and min(gaps) >= 0.08 * (places[-1] - places[0])


def _lines(results, axis, metric):
    """{label: [(x, y, floor)]}, one line for each combination of what varies besides `axis`."""
    lines, rows = {}, results["rows"]
    several = [name for name in ("model", "reference", "scene") if len({row[name] for row in rows}) > 1]
    if not several and len(results["axes"]) < 2:
        several = ["model"]
    for row in rows:
        x, y = _number(row, axis), row["metrics"].get(metric)
        if x is None or y is None or not math.isfinite(y):
            continue
        words = [LABELS.get(row[name], row[name]) for name in several]
        words += [f"{name}={text(row['parameters'].get(name))}" for name in results["axes"] if name != axis]
        lines.setdefault(" ".join(words), []).append((x, y, row["noise_floor"].get(metric) or 0.0))
    return lines


def _number(row, axis):
    value = row["parameters"].get(axis)
    if isinstance(value, list):
        return value[0] if len(set(value)) == 1 else None
    return value if isinstance(value, (int, float)) else None


def text(value):
    """A parameter's value as it is read: a colour as one number where its channels are equal, a choice by its label."""
    if isinstance(value, list):
        return "/".join(f"{channel:g}" for channel in (value if len(set(value)) > 1 else value[:1]))
    return f"{value:g}" if isinstance(value, (int, float)) else "–" if value is None else LABELS.get(value, str(value))

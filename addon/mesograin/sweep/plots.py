# Draws a sweep: each metric over each axis that is a number, a line for everything else that varies.
"""See `draw`."""
import os
import re

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


def draw(plan, rows, out):
    """Writes METRIC-over-AXIS.svg and .png for every axis with at least two numbers; returns their paths.

    The error bar of a point is the noise floor of its reference, where the metric has one.
    """
    made = []
    for axis in plan.axes:
        numbers = {_number(row, axis) for row in rows} - {None}
        if len(numbers) < 2:
            continue
        for metric, title in METRICS.items():
            made += _plot(plan, rows, axis, numbers, metric, title, out)
    return made


def _plot(plan, rows, axis, numbers, metric, title, out):
    import matplotlib

    matplotlib.use("Agg")
    # Text stays text, and the file says nothing of the time it was made, so that the same results give the same plot.
    matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "mesograin"})
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(7.2, 4.4), layout="constrained")
    for label, line in _lines(plan, rows, axis, metric).items():
        line.sort()
        x, y, floor = zip(*line, strict=True)
        axes.errorbar(x, y, yerr=floor, label=label, marker="o", markersize=4, linewidth=1.4, capsize=2)
    if min(numbers) > 0 and max(numbers) / min(numbers) > 20:
        axes.set_xscale("log")
    if metric == "bias":
        axes.axhline(1.0, color="0.5", linewidth=0.8, zorder=0)
    else:
        axes.set_ylim(bottom=0.0)
    axes.set_xlabel(UNITS.get(axis, axis))
    axes.set_ylabel(title)
    axes.set_title(plan.title)
    axes.grid(alpha=0.25)
    axes.legend(fontsize="small")
    paths = []
    for ending, options in (("svg", {"metadata": {"Date": None}}), ("png", {"dpi": 150})):
        path = out / f"{metric}-over-{axis}.{ending}"
        partial = path.with_name(f".{os.getpid()}.{path.name}")
        figure.savefig(partial, format=ending, **options)
        partial.replace(path)
        paths.append(path)
    pyplot.close(figure)
    return paths


def _lines(plan, rows, axis, metric):
    """{label: [(x, y, floor)]}, one line for each combination of what varies besides `axis`."""
    lines = {}
    models = {row["model"] for row in rows}
    references = {row["reference"] for row in rows}
    scenes = {row["scene"] for row in rows}
    for row in rows:
        x = _number(row, axis)
        if x is None or row["metrics"].get(metric) is None:
            continue
        words = [row["model"]] if len(models) > 1 or not plan.axes[1:] else []
        words += [row["reference"]] if len(references) > 1 else []
        words += [row["scene"]] if len(scenes) > 1 else []
        words += [f"{name}={_text(row['parameters'].get(name))}" for name in plan.axes if name != axis]
        floor = row["noise_floor"].get(metric) or 0.0
        lines.setdefault(" ".join(words), []).append((x, row["metrics"][metric], floor))
    return lines


def _number(row, axis):
    value = row["parameters"].get(axis)
    if isinstance(value, list):
        return value[0] if len(set(value)) == 1 else None
    return value if isinstance(value, (int, float)) else None


def _text(value):
    if isinstance(value, list):
        value = value if len(set(value)) > 1 else value[:1]
        return "/".join(f"{channel:g}" for channel in value)
    return re.sub(r"\.0$", "", str(value))

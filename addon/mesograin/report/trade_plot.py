# The plot of a trade curve: error against milliseconds, ours and the path tracer's, with the Pareto front.
"""See `trade`."""

import itertools

from ..schema import labels
from .plots import log_axis, new_figure, percent
from .wording import metric, times

MARKERS = ("o", "s", "^", "D", "v", "P", "X")
LEGEND_LEAVES = 0.7
"""Of the figure's width, about."""


def trade(results):
    """A plot of all points of a trade.json on logarithmic axes, a line for each setting that only samples refine.

    A whisker reaches up to the error before the converged render's noise was taken off; a hollow point is at most
    where it stands. Below the dotted line nothing can be told.
    """

    def draw(palette):
        points = results["points"]
        if not points:
            return None
        figure, axes = new_figure(9.0, 5.0)
        axes.set_xscale("log")
        axes.set_yscale("log")
        judged_by = results["reference"]["judged_by"]
        _front(axes, results, palette)
        models = dict.fromkeys(point["model"] for point in points if point["side"] != "traced")
        colours = dict(zip(reversed(models), itertools.cycle((palette.ours, palette.second, palette.third))))
        lines = {}
        for point in points:
            lines.setdefault((point["side"], point["model"], point["taps"]), []).append(point)
        for number, ((side, model, taps), line) in enumerate(lines.items()):
            colour = palette.theirs if side == "traced" else colours[model]
            label = labels.of_model(model) + (f", {taps} taps" if taps else "")
            _line(axes, line, colour, MARKERS[number % len(MARKERS)], label, palette, judged_by)
        floor = results["reference"]["noise_floor"]
        axes.axhline(floor, color=palette.quiet, linewidth=0.9, linestyle=(0, (1, 2)),
                     label="noise floor of the converged render")
        gain = _gain(axes, results, palette)
        axes.set_xlabel("time of a picture")
        axes.set_ylabel(f"error: {metric(judged_by)},\nthe converged render's noise taken off")
        reached = [entry["traced_milliseconds"] for entry in results["summary"][:1] if entry["traced_milliseconds"]]
        log_axis(axes.xaxis, [*reached, *(point["milliseconds"] for point in points)], 1.7, _tick, steps=(1,))
        errors = [size for point in points for size in (point["error"], point["metrics"][judged_by])]
        log_axis(axes.yaxis, [*errors, floor], 1.5, percent, steps=(1, 2, 5))
        _label(axes, points, gain, palette)
        axes.grid(True, which="major")
        axes.legend(frameon=False, fontsize=8, loc="upper left", bbox_to_anchor=(1.0, 1.0))
        return figure

    return draw


def _line(axes, line, colour, marker, label, palette, judged_by):
    times = [point["milliseconds"] for point in line]
    axes.plot(times, [point["error"] for point in line], color=colour, linewidth=1.1, alpha=0.8)
    for number, point in enumerate(line):
        at, error = point["milliseconds"], point["error"]
        raw = max(error, point["metrics"][judged_by])
        axes.plot([at] * 2, [error, raw], color=colour, linewidth=0.8, alpha=0.4)
        axes.plot([at], [error], marker=marker, markersize=5.5, color=colour, linestyle="none",
                  fillstyle="full" if point["resolved"] else "none", label=label if number == 0 else None)


def _label(axes, points, gain, palette):
    """The number of samples under or over each point, where it covers no other number or point. Once the axes have
    their limits. gain: where the factor stands, or None."""

    def place(at):
        # The legend takes its share of the width when the figure is laid out.
        x, y = axes.transData.transform(at) * 72.0 / axes.figure.dpi
        return LEGEND_LEAVES * x, y

    places = [place((point["milliseconds"], point["error"])) for point in points]
    taken = [(x, y, 4.0, 4.0) for x, y in places]
    if gain is not None:
        x, y = place(gain)
        taken.append((x, y + 9.0, 24.0, 7.0))
    for at, (point, (x, y)) in enumerate(zip(points, places, strict=True)):
        text = f"{point['samples']}"
        wide = 2.4 * len(text) + 1.0
        others = taken[:at] + taken[at + 1:]
        for side in (-1, 1):
            middle = y + 10.0 * side
            if any(abs(x - u) < wide + w and abs(middle - v) < 4.0 + h for u, v, w, h in others):
                continue
            axes.annotate(text, (point["milliseconds"], point["error"]), (0, 6 * side), textcoords="offset points",
                          ha="center", va="top" if side < 0 else "bottom", fontsize=7, color=palette.quiet)
            taken.append((x, middle, wide, 4.0))
            break


def _tick(milliseconds, _):
    return f"{milliseconds:g} ms" if milliseconds < 1000 else f"{milliseconds / 1000:g} s"


def _front(axes, results, palette):
    """The Pareto front as stairs: what can be had within each time."""
    places = {point["name"]: (point["milliseconds"], point["error"]) for point in results["points"]}
    front = [places[name] for name in results["front"]]
    last = max(time for time, _ in places.values()) * 1.7
    axes.step([time for time, _ in front] + [last], [error for _, error in front] + [front[-1][1]], where="post",
              color=palette.ink, linewidth=6.0, alpha=0.12, label="Pareto front", solid_joinstyle="round")


def _gain(axes, results, palette):
    """The arrow from our most exact setting to where the path tracer is as near; returns its middle, or None."""
    entry = next(iter(results["summary"]), None)
    if entry is None or not entry["ratio"] or entry["ratio"] < 2.0:
        return None
    if entry["traced_known"] == "beyond":
        last = max((point for point in results["points"] if point["side"] == "traced"),
                   key=lambda point: point["milliseconds"])
        axes.plot([last["milliseconds"], entry["traced_milliseconds"]], [last["error"], entry["error"]],
                  color=palette.theirs, linewidth=1.1, linestyle=(0, (4, 3)), alpha=0.8)
    ours, theirs, error = entry["milliseconds"], entry["traced_milliseconds"], entry["error"]
    axes.annotate("", (theirs, error), (ours, error), arrowprops={
        "arrowstyle": "<->", "color": palette.quiet, "linewidth": 0.9, "shrinkA": 6, "shrinkB": 2})
    middle = ((ours * theirs) ** 0.5, error)
    axes.annotate(times(entry["ratio"]), middle, (0, 3), textcoords="offset points", ha="center", va="bottom",
                  fontsize=10, color=palette.ink)
    return middle

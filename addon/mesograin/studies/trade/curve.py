# What measured points come to: the Pareto front, how long the path tracer needs for an error, and that in a sentence.
"""Points are dicts with `side` ('mesograin' or 'traced'), `milliseconds`, `error` and `resolved`; see `place`."""

import math

from ...report.wording import duration, times
from ...schema import labels

RESOLVED = 0.25
"""An error below this share of the reference's noise floor is not told from none: taking the floor off in quadrature
leaves an uncertain rest."""

NEAR_BEST = 1.1
"""A setting whose error is within this factor of a model's best is as good; the cheapest of them is the one to name."""

SHOWN = {
    "once_solved": "as a viewport shows it once light between grains is solved",
    "in_known_light": "in light that a viewport has shown before",
    "from_nothing": "nothing known of light between grains before it",
}
"""What a viewport's picture of one sample is told as; keys as results have them."""


def place(metrics, noise_floor, judged_by="relative_l1"):
    """{'error', 'resolved'} of a point: the metric that judges with the reference's noise taken off, or, where that is
    too small to be told from none, the smallest error that can be, with `resolved` False. metrics: of native.compare.
    """
    smallest = RESOLVED * noise_floor[judged_by]
    error = metrics[f"{judged_by}_corrected"]
    return {"error": max(error, smallest), "resolved": error > smallest}


def front(points):
    """Indices of the points that no other beats in both time and error, from the fastest to the most exact."""
    best, found = math.inf, []
    for index in sorted(range(len(points)), key=lambda at: (points[at]["milliseconds"], points[at]["error"])):
        if points[index]["error"] < best:
            best = points[index]["error"]
            found.append(index)
    return found


def traced_time(points, error):
    """(milliseconds that the path tracer needs to come as near as `error`, how that is known) from its measured points.

    How: 'between' two points (straight lines in logarithms), 'beyond' the last one, where the error of a path tracer
    falls with the root of its time, or 'below' the first: its time is then an upper bound. (None, None) without points.
    """
    measured = sorted((point["milliseconds"], point["error"]) for point in points if point["side"] == "traced")
    measured = [(time, size) for time, size in measured if time > 0.0 and size > 0.0]
    if not measured or error <= 0.0:
        return None, None
    if error >= measured[0][1]:
        return measured[0][0], "below"
    for (time, size), (next_time, next_size) in zip(measured, measured[1:]):
        if next_size <= error < size:
            share = math.log(size / error) / math.log(size / next_size)
            return time * (next_time / time) ** share, "between"
    time, size = min(measured, key=lambda point: point[1])
    return time * (size / error) ** 2, "beyond"


def summary(points):
    """One entry for each model, the most exact one first: its cheapest setting that is as good as its best, and how
    long the path tracer needs for the same error.

    Each entry is a dict with `point` (an index), `error`, `milliseconds`, `traced_milliseconds`, `traced_known` (see
    `traced_time`), `ratio` and `sentence`.
    """
    entries = []
    for model in dict.fromkeys(point["model"] for point in points if point["side"] == "mesograin"):
        own = [at for at, point in enumerate(points) if point["side"] == "mesograin" and point["model"] == model]
        least = min(points[at]["error"] for at in own)
        chosen = min(
            (at for at in own if points[at]["error"] <= NEAR_BEST * least), key=lambda at: points[at]["milliseconds"]
        )
        count = points[chosen]["samples"]
        setting = f"{count} sample{'s' if count > 1 else ''}"
        entries.append({"point": chosen, **_beside_traced(points[chosen], points, setting)})
    return sorted(entries, key=lambda entry: (entry["error"], entry["milliseconds"]))


def shown(of, point, points):
    """The entry of a picture of one sample that is no point of the curve, as `summary` has one; of: a key of SHOWN."""
    return _beside_traced(point, points, f"1 sample, {SHOWN[of]}")


def _beside_traced(point, points, setting):
    theirs, known = traced_time(points, point["error"])
    entry = {
        "error": point["error"],
        "milliseconds": point["milliseconds"],
        "traced_milliseconds": theirs,
        "traced_known": known,
        "ratio": theirs / point["milliseconds"] if theirs else None,
    }
    tracer = next((each["model"] for each in points if each["side"] == "traced"), None)
    return {**entry, "sentence": _sentence(point, entry, setting, tracer)}


def _sentence(point, entry, setting, tracer):
    taps = f" of {point['taps']} taps" if point["taps"] else ""
    known = entry["traced_known"]
    off = _share(entry["error"]) if point["resolved"] else f"at most {_share(entry['error'])}"
    ours = f"{labels.of_model(point['model'])} with {setting}{taps}: {off} at {duration(entry['milliseconds'])}"
    if known is None:
        return f"{ours}."
    if known == "below":
        return f"{ours}; {tracer} is as near after {duration(entry['traced_milliseconds'])} or less."
    least = "" if point["resolved"] else "at least "
    extrapolated = ", extrapolated" if known == "beyond" else ""
    needed = f"{least}{duration(entry['traced_milliseconds'])}"
    return f"{ours}; {tracer} needs {needed} for the same error{extrapolated}: {times(entry['ratio'])}."


def _share(value):
    return f"{100.0 * value:.2g} %" if value < 0.0995 else f"{100.0 * value:.0f} %"

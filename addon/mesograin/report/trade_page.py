# The page of a trade curve: the sentences, the plot, pictures of what each setting gives, the table.
"""See `build`."""

from pathlib import Path

from markupsafe import Markup

from ..schema.labels import of_model
from . import colours, page_builder, plots, trade_plot
from .wording import duration, form, label, metric, parameters

COLUMNS = tuple((key, label(key), how) for key, how in (
    ("model", None),
    ("taps", "count"),
    ("samples", "count"),
    ("milliseconds", "number"),
    ("error", "percent"),
    ("metrics.relative_l1", "percent"),
    ("metrics.relative_l1_blocks", "percent"),
    ("metrics.bias", "ratio"),
    ("metrics.rse_mean", "number"),
))
TRACED_PICTURES = 4
"""How many of the path tracer's renders are shown, at most."""


def build(results, pictures, folder):
    """The page's text; its plot is also written into FOLDER/plots, as SVG and PNG. Raises OSError.

    results: of trade.json. pictures: {point's name, or "reference": (h, w, 4) linear pixels}."""
    stops = colours.exposure_for(pictures["reference"], pictures["reference"][..., 3] > 0.999)
    shown = [_shown("converged", "", results["reference"]["title"], pictures["reference"], stops)]
    for point in _pictured(results):
        count = f"{point['samples']} sample{'s' if point['samples'] > 1 else ''}"
        setting = count + (f" of {point['taps']} taps" if point["taps"] else "")
        text = f"{_error(point)} at {duration(point['milliseconds'])}"
        shown.append(_shown(of_model(point["model"]), setting, text, pictures[point["name"]], stops))
    return page_builder.render(
        "trade.html.j2",
        results=results,
        plot=page_builder.plot(trade_plot.trade(results), Path(folder) / page_builder.PLOTS, "trade"),
        shown=shown,
        columns=[
            {"key": key, "title": title, "definition": results["definitions"].get(key.rpartition(".")[2], "")}
            for key, title, _ in COLUMNS
        ],
        rows=[_row(point, point["name"] in results["front"]) for point in results["points"]],
        parameters=parameters(results["material"]),
        judged_by=metric(results["reference"]["judged_by"]),
        exposure=stops,
    )


def _shown(title, setting, text, pixels, stops):
    picture = Markup(plots.png(colours.expose(pixels, stops)))
    return {"title": title, "setting": setting, "text": text, "png": picture}


def _row(point, on_front):
    cells = []
    for key, _, how in COLUMNS:
        value = page_builder.look_up(point, key)
        text = "–" if value is None else str(value) if how in (None, "count") else form(value, how)
        if key == "model":
            text = of_model(value)
        if key == "error":
            text = _error(point)
        cells.append({"text": text, "value": value if how else None, "number": how is not None})
    return {"cells": cells, "front": on_front, "picture": point["picture"]}


def _error(point):
    """What is not told from none is at most what stands."""
    return ("" if point["resolved"] else "≤ ") + form(point["error"], "percent")


def _pictured(results):
    """The points shown as pictures: the setting that is named for each model, then some of the tracer's."""
    points = results["points"]
    theirs = [point for point in points if point["side"] == "traced"]
    some = sorted({round(at * (len(theirs) - 1) / (TRACED_PICTURES - 1)) for at in range(TRACED_PICTURES)})
    return [points[entry["point"]] for entry in results["summary"]] + [theirs[at] for at in some if theirs]

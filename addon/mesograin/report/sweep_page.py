# The page of a sweep: the plots, and a table of all cases with their pictures, that can be sorted.
"""See `build`."""

from pathlib import Path

from ..cycles.wording import LABELS, in_labels
from . import page_builder, sweep_plot
from .wording import controls, form, label

COLUMNS = tuple((key, label(key), how) for key, how in (
    ("metrics.relative_l1", "percent"),
    ("noise_floor.relative_l1", "percent"),
    ("metrics.relative_l1_corrected", "percent"),
    ("metrics.relative_l1_blocks", "percent"),
    ("significance.share", "percent"),
    ("metrics.bias", "ratio"),
    ("metrics.rse_mean", "number"),
    ("frame_ms", "milliseconds"),
    ("reference_seconds", "seconds"),
))
PICTURED = 200
"""How many cases show their pictures in the page, at most; the others link to them."""


def build(results, origin, rows, folder):
    """The page's text; its plots are also written into FOLDER/plots, as SVG and PNG. Raises OSError.

    results: of a sweep's results.json. origin: of its origin.json. rows: `reading.SweepRow` for each of its rows."""
    definitions = results["definitions"]
    place = Path(folder) / page_builder.PLOTS
    plots = [
        page_builder.plot(sweep_plot.over(results, axis, metric), place, f"{metric}-over-{axis}")
        for axis in sweep_plot.numeric_axes(results)
        for metric in sweep_plot.METRICS
    ]
    about = {
        **origin,
        "scene": results["title"],
        "complete": origin["cases"] == len(results["rows"]),
        "definitions": definitions,
        "settings": {"colour_space": "linear, scene-referred"},
    }
    return page_builder.render(
        "sweep.html.j2",
        results=about,
        done=len(results["rows"]),
        failures=[{"label": in_labels(failure["label"]), "error": in_labels(failure["error"])}
                  for failure in results["failures"]],
        plots=[each for each in plots if each],
        headline=_headline(results["rows"]),
        **_controls(results["rows"]),
        names=_names(results),
        axes=results["axes"],
        columns=[
            {"key": key, "title": title, "definition": page_builder.definition(definitions, key)}
            for key, title, _ in COLUMNS
        ],
        rows=[_row(row, results, number) for number, row in enumerate(rows)],
    )


def _headline(rows):
    """From which error to which; "" where none is known."""
    known = [row for row in rows if row["metrics"].get("relative_l1") is not None]
    if not known:
        return ""
    least, most = (choose(known, key=lambda row: row["metrics"]["relative_l1"]) for choose in (min, max))
    low, high = (form(row["metrics"]["relative_l1"], "percent") for row in (least, most))
    return f"Relative L1 from {low} ({in_labels(least['label'])}) to {high} ({in_labels(most['label'])})."


def _controls(rows):
    """What all controls come to, in a sentence, and which of them are wrong: [(case, sentence)]; "" where none was
    asked for."""
    told = [(in_labels(row["label"]), controls(row)) for row in rows if row.get("controls")]
    if not told:
        return {"controls": "", "wrong_controls": []}
    wrong = [(label, sentence) for label, pair in told for right, sentence in pair if not right]
    quiet, found = (sum(pair[which][0] for _, pair in told) for which in (0, 1))
    sentence = (f"The significance test where the truth is known: of {len(told)} identical materials"
                f" {len(told) - quiet} are called different, of {len(told)} wrong ones {found}.")
    return {"controls": sentence, "wrong_controls": wrong}


def _names(results):
    """What a case is called by: the model, and what else is not the same in all of them."""
    return [name for name in ("scene", "model", "reference", "part")
            if name == "model" or len({row[name] for row in results["rows"]}) > 1]


def _row(row, results, number):
    """What the template needs of one case. row: reading.SweepRow."""
    values = {**row.entry, **row.timings}
    cells = [
        {"text": sweep_plot.text(row.entry["parameters"].get(axis)), "value": _sortable(row.entry, axis)}
        for axis in results["axes"]
    ]
    numbers = []
    for key, _, how in COLUMNS:
        value = page_builder.look_up(values, key)
        numbers.append({"text": form(value, how), "value": value})
    significance = row.entry["significance"]
    return {
        "entry": row.entry,
        "label": in_labels(row.entry["label"]),
        "names": [LABELS.get(row.entry[name], row.entry[name]) for name in _names(results)],
        "cells": cells,
        "numbers": numbers,
        "files": row.files,
        "png": row.png if number < PICTURED else {},
        "controls": controls(row.entry),
        "differs": None if significance is None else significance["verdict"] == "differs",
    }


def _sortable(entry, axis):
    """A number where the parameter is one, or a colour whose channels have a mean."""
    value = entry["parameters"].get(axis)
    if isinstance(value, list):
        return sum(value) / len(value)
    return value if isinstance(value, (int, float)) else None

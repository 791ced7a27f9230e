# Puts the results of a sweep's cases into one table, in the plan's order, whoever ran them.
"""See `merge` and `describe`."""
import csv
import datetime
import io
import os

from ...report.reading import ORIGIN, SWEEP_FORMAT
from ...report.reading import TIMINGS as TIMINGS_FILE
from ..comparison import definitions
from .folder import RESULTS, write, write_text

TIMINGS = ("frame_ms", "reference_seconds")
"""What differs from run to run; kept in a table of its own so that the results can be compared bit for bit."""


def merge(plan, folder):
    """Writes results.json, results.csv and timings.csv into the sweep's folder; returns the rows and the cases missing.

    A row is {'label', 'scene', 'model', 'reference', 'part', 'parameters', 'metrics',
    'noise_floor', 'mask', 'significance', 'controls',
    'folder', 'files'}; docs/comparing.md defines them.
    """
    rows, timings, missing, failures = [], [], [], []
    for case in plan.cases:
        if not folder.finished(case):
            missing.append(case)
            failure = folder.failure(case)
            if failure:
                failures.append({"label": case.label, "error": failure["error"]})
            continue
        for result in folder.results(case)["cases"]:
            parameters = dict(case.parameters)
            row = {
                "label": case.label,
                "scene": os.path.basename(case.scene),
                "model": result["model"],
                "reference": result["reference"],
                "part": result.get("part", "whole"),
                "parameters": parameters,
                "metrics": result["metrics"],
                "noise_floor": result["noise_floor"],
                "mask": result["mask"],
                "significance": result.get("significance"),
                "controls": result.get("controls"),
                "folder": str(folder.place(case)),
                "files": result.get("files", {}),
            }
            rows.append(row)
            timings.append({"label": case.label, **{name: result.get(name) for name in TIMINGS}})
    names = sorted({name for row in rows for name in row["metrics"]})
    write(folder.out / RESULTS, {
        "format": SWEEP_FORMAT[0],
        "format_version": SWEEP_FORMAT[1],
        "title": plan.title,
        "axes": plan.axes,
        "definitions": definitions.all_definitions(names),
        "rows": rows,
        "failures": failures,
    })
    _write_csv(folder.out / "results.csv", [_flat(row) for row in rows])
    _write_csv(folder.out / TIMINGS_FILE, timings)
    return rows, missing


def describe(plan, folder, command):
    """Writes origin.json, which differs from run to run: when, by which command and on what the sweep was run. The
    versions and the machine are those of its first finished case."""
    first = next((folder.results(case) for case in plan.cases if folder.finished(case)), {})
    write(folder.out / ORIGIN, {
        "created": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"),
        "command": command,
        "cases": len(plan.cases),
        **{name: first.get(name) for name in ("versions", "device", "cpu")},
    })


def _flat(row):
    flat = {name: row[name] for name in ("label", "scene", "model", "reference", "part")}
    for name, value in row["parameters"].items():
        flat[name] = " ".join(repr(channel) for channel in value) if isinstance(value, list) else value
    for group in ("metrics", "noise_floor", "mask", "significance"):
        for name, value in (row[group] or {}).items():
            flat[name if group == "metrics" else f"{group}.{name}"] = value
    for name, test in (row["controls"] or {}).items():
        flat[f"controls.{name}"] = test["verdict"]
    return flat


def _write_csv(path, rows):
    names = list(dict.fromkeys(name for row in rows for name in row))
    text = io.StringIO()
    writer = csv.DictWriter(text, names, restval="")
    writer.writeheader()
    writer.writerows(rows)
    write_text(path, text.getvalue())

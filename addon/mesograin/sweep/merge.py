# Puts the results of a sweep's cases into one table, in the plan's order, whoever ran them.
"""See `merge`."""
import csv
import os

from .folder import RESULTS, write

TIMINGS = ("frame_ms", "reference_seconds")
"""What differs from run to run; kept in a table of its own so that the results can be compared bit for bit."""


def merge(plan, folder):
    """Writes results.json, results.csv and timings.csv into the sweep's folder; returns the rows and the cases missing.

    A row is {'label', 'scene', 'model', 'reference', 'parameters', 'metrics', 'noise_floor', 'mask', 'significance',
    'folder'}; docs/comparing.md defines them.
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
                "parameters": parameters,
                "metrics": result["metrics"],
                "noise_floor": result["noise_floor"],
                "mask": result["mask"],
                "significance": result.get("significance"),
                "folder": str(folder.place(case)),
            }
            rows.append(row)
            timings.append({"label": case.label, **{name: result.get(name) for name in TIMINGS}})
    write(folder.out / RESULTS, {"title": plan.title, "axes": plan.axes, "rows": rows, "failures": failures})
    _write_csv(folder.out / "results.csv", [_flat(row) for row in rows])
    _write_csv(folder.out / "timings.csv", timings)
    return rows, missing


def _flat(row):
    flat = {name: row[name] for name in ("label", "scene", "model", "reference")}
    for name, value in row["parameters"].items():
        flat[name] = " ".join(repr(channel) for channel in value) if isinstance(value, list) else value
    for group in ("metrics", "noise_floor", "mask", "significance"):
        for name, value in (row[group] or {}).items():
            flat[name if group == "metrics" else f"{group}.{name}"] = value
    return flat


def _write_csv(path, rows):
    names = list(dict.fromkeys(name for row in rows for name in row))
    partial = path.with_name(f".{path.name}.{os.getpid()}")
    with partial.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, names, restval="")
        writer.writeheader()
        writer.writerows(rows)
    partial.replace(path)

# Reads the results of a comparison, a sweep or a trade curve, and the pictures they name.
"""See `read`, `read_sweep` and `read_trade`."""

import base64
import csv
import importlib.machinery
import importlib.util
import json
import os
from dataclasses import dataclass
from pathlib import Path

import numpy

NATIVE = "mesograin_native"


class UnreadableError(Exception):
    """Results cannot be read; one sentence."""


@dataclass(frozen=True)
class CasePictures:
    """A case with its pictures. case: its entry in results.json. model, reference: (h, w, 4) float32, linear; mask: (h,
    w) bool, the pixels compared; noise: (h, w, 3), the reference's standard error; scores: (h, w), of the significance
    test the score farthest from 0 of a pixel's channels; None if it failed, or where there is one seed only.
    png: {name in `files`: data URI}."""

    case: dict
    model: numpy.ndarray = None
    reference: numpy.ndarray = None
    mask: numpy.ndarray = None
    noise: numpy.ndarray = None
    scores: numpy.ndarray = None
    png: dict = None


@dataclass(frozen=True)
class SweepRow:
    """A case of a sweep. entry: its row in results.json. timings: {name: number} of timings.csv. files: {name: path
    from the sweep's folder}. png: {name in `files`: data URI}."""

    entry: dict
    timings: dict
    files: dict
    png: dict


RESULTS, TRADE, ORIGIN, TIMINGS = "results.json", "trade.json", "origin.json", "timings.csv"
RESULTS_FORMAT, SWEEP_FORMAT, TRADE_FORMAT = ("mesograin-results", 1), ("mesograin-sweep", 1), ("mesograin-trade", 6)
"""(`format`, `format_version`) of the files, for who writes them and who reads them."""


def read(folder):
    """(results, [CasePictures]) of a comparison's folder. Raises UnreadableError with a sentence."""
    folder = Path(folder)
    results = _load(folder / RESULTS, RESULTS_FORMAT, "a comparison")
    native = _native()
    return results, [_pictures(native, folder, case) for case in results["cases"]]


def is_sweep(folder):
    """Whether a folder's results.json is that of a sweep."""
    try:
        return json.loads((Path(folder) / RESULTS).read_text(encoding="utf-8")).get("format") == SWEEP_FORMAT[0]
    except (OSError, ValueError, AttributeError):
        return False


def read_sweep(folder):
    """(results, origin, [SweepRow]) of a sweep's folder. Raises UnreadableError with a sentence."""
    folder = Path(folder)
    results = _load(folder / RESULTS, SWEEP_FORMAT, "a sweep")
    origin = _json(folder / ORIGIN)
    with open(folder / TIMINGS, newline="", encoding="utf-8") as file:
        timings = list(csv.DictReader(file))
    return results, origin, [_sweep_row(folder, *pair) for pair in zip(results["rows"], timings, strict=True)]


def _sweep_row(folder, entry, timings):
    numbers = {name: float(value) for name, value in timings.items() if name != "label" and value}
    files = {name: f"{entry['folder']}/{path}" for name, path in entry["files"].items()}
    shown = {name: path for name, path in files.items() if name in ("model_png", "reference_png", "error_png")}
    try:
        png = {name: _data_uri(folder / path) for name, path in shown.items()}
    except OSError as error:
        raise UnreadableError(f"{error.filename} cannot be read ({error.strerror}).") from error
    return SweepRow(entry, numbers, files, png)


def read_trade(folder):
    """(results, {point's name, or "reference": (h, w, 4) linear pixels}) of a trade curve's folder. Raises
    UnreadableError with a sentence."""
    folder = Path(folder)
    results = _load(folder / TRADE, TRADE_FORMAT, "a trade curve")
    native = _native()
    wanted = {"reference": "pictures/reference.exr", **{point["name"]: point["picture"] for point in results["points"]}}
    try:
        return results, {name: native.read_exr(folder / path)[0] for name, path in wanted.items()}
    except native.Error as error:
        raise UnreadableError(str(error)) from error


def _json(path):
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise UnreadableError(f"{path} cannot be read ({error.strerror}).") from error
    except ValueError as error:
        raise UnreadableError(f"{path} is not JSON ({error}).") from error


def _load(path, form, what):
    results = _json(path)
    if not isinstance(results, dict) or results.get("format") != form[0]:
        raise UnreadableError(f"{path} holds no results of {what}.")
    if results.get("format_version") != form[1]:
        raise UnreadableError(
            f"{path} has format version {results.get('format_version')}; this report reads version {form[1]}."
        )
    return results


def _pictures(native, folder, case):
    if case["status"] != "done":
        return CasePictures(case)
    files = case["files"]
    try:
        pixels = {
            name: native.read_exr(folder / files[name])[0]
            for name in ("model", "reference", "mask", "noise", "z_map")
            if name in files
        }
    except native.Error as error:
        raise UnreadableError(str(error)) from error
    try:
        png = {name: _data_uri(folder / path) for name, path in files.items() if path.endswith(".png")}
    except OSError as error:
        raise UnreadableError(f"{error.filename} cannot be read ({error.strerror}).") from error
    scores = pixels.get("z_map")
    if scores is not None:
        farthest = numpy.abs(scores).argmax(axis=-1)[..., None]
        scores = numpy.take_along_axis(scores, farthest, axis=-1)[..., 0]
    mask = pixels["mask"][..., 0] > 0.5 if "mask" in pixels else native.default_mask(pixels["reference"][..., 3])
    return CasePictures(case, pixels["model"], pixels["reference"], mask, pixels.get("noise"), scores, png)


def _data_uri(path):
    return "data:image/png;base64," + base64.b64encode(path.read_bytes()).decode("ascii")


def _native():
    """The module that reads EXR files: in MESOGRAIN_NATIVE_DIR, or beside the add-on."""
    folder = Path(os.environ.get("MESOGRAIN_NATIVE_DIR") or Path(__file__).resolve().parents[1])
    spec = importlib.machinery.PathFinder.find_spec(NATIVE, [str(folder)])
    if spec is None or spec.loader is None:
        suffix = importlib.machinery.EXTENSION_SUFFIXES[0]
        raise UnreadableError(
            f"the native module {NATIVE}{suffix} is needed to read EXR files, and is not in {folder}."
        )
    try:
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
    except ImportError as error:
        raise UnreadableError(f"the native module {spec.origin} cannot be loaded ({error}).") from error
    return module

# Puts results, pictures, plots, style and script into one HTML file that needs nothing else.
"""See `build`."""

import json
from pathlib import Path

import jinja2
import numpy
from markupsafe import Markup

from . import colours, payload, plots

PAGE = Path(__file__).resolve().parent / "page"
LIVE_BUDGET = 48 * 2**20
"""Characters of packed pictures in one page; cases beyond it are shown as still pictures."""

# The numbers that lead the table and each case, with how to write them: (key, title, form).
LEADING = (
    ("metrics.relative_l1", "relative L1", "percent"),
    ("noise_floor.relative_l1", "noise floor", "percent"),
    ("metrics.relative_l1_corrected", "L1, noise taken off", "percent"),
    ("metrics.relative_l1_blocks", "L1 in 8×8 blocks", "percent"),
    ("metrics.bias", "bias", "ratio"),
    ("metrics.rse_mean", "mean RSE", "number"),
    ("metrics.rse_max", "max RSE", "number"),
    ("frame_ms", "ms a frame", "milliseconds"),
    ("reference_seconds", "Cycles, s", "seconds"),
)


def build(results, cases):
    """The page's text. cases: [reading.CasePictures], in the order of results["cases"]."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(PAGE),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
    )
    environment.filters["form"] = form
    views, spent = [], 0
    for pictures in cases:
        view = _view(pictures, results["definitions"], LIVE_BUDGET - spent)
        spent += view["size"]
        views.append(view)
    done = [pictures.case for pictures in cases if pictures.case["status"] == "done"]
    return environment.get_template("report.html.j2").render(
        results=results,
        cases=views,
        leading=[
            {"key": key, "title": title, "form": how, "definition": _definition(results["definitions"], key)}
            for key, title, how in LEADING
        ],
        trade=Markup(plots.trade(done)) if done else "",
        style=Markup((PAGE / "report.css").read_text(encoding="utf-8")),
        script=Markup((PAGE / "report.js").read_text(encoding="utf-8")),
        colour_tables=Markup(_colour_tables()),
        sequential=_gradient(colours.SEQUENTIAL),
        diverging=_gradient(colours.DIVERGING),
        error_range=colours.ERROR_RANGE,
        signed_range=colours.SIGNED_RANGE,
    )


def _view(pictures, definitions, budget):
    """What the template needs of one case."""
    case = pictures.case
    view = {
        "case": case,
        "done": case["status"] == "done",
        "size": 0,
        "live": None,
        "numbers": [],
        "others": [],
        "parameters": _parameters(case["material"]),
    }
    if not view["done"]:
        return view
    view["png"] = pictures.png
    packed = {
        "model": payload.pack(pictures.model[..., :3]),
        "reference": payload.pack(pictures.reference[..., :3]),
        "mask": payload.pack(pictures.mask[..., None]),
    }
    size = sum(len(text) for text in packed.values())
    if size <= budget:
        height, width = pictures.model.shape[:2]
        view["live"] = Markup(json.dumps({"width": width, "height": height, "stops": case["exposure_stops"], **packed}))
        view["size"] = size
    relative = colours.relative_error(pictures.model, pictures.reference)
    view["profile"] = Markup(plots.profile(pictures.model, pictures.reference))
    view["histogram"] = Markup(plots.histogram(relative, pictures.mask))
    view["numbers"] = [
        {
            "title": title,
            "text": form(_get(case, key), how),
            "value": _get(case, key),
            "definition": _definition(definitions, key),
        }
        for key, title, how in LEADING
    ]
    view["others"] = [
        {
            "title": name,
            "text": form(value, "number"),
            "floor": form(case["noise_floor"].get(name), "number"),
            "definition": definitions.get(name, ""),
        }
        for name, value in case["metrics"].items()
    ]
    view["verdict"] = _verdict(case)
    return view


def _get(case, key):
    value = case
    for part in key.split("."):
        value = value.get(part) if isinstance(value, dict) else None
    return value


def _definition(definitions, key):
    group, _, name = key.rpartition(".")
    if group == "noise_floor":
        return f"{definitions['noise_floor']}; here for {name}: {definitions.get(name, '')}"
    return definitions.get(name) or definitions.get(key, "")


def _parameters(material):
    """[(material name, [(parameter, text)])]."""
    return [
        (name, [(parameter, _text(value)) for parameter, value in values.items()]) for name, values in material.items()
    ]


def _text(value):
    if isinstance(value, list):
        parts = [f"{number:.4g}" for number in value]
        return parts[0] if len(set(parts)) == 1 else ", ".join(parts)
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _verdict(case):
    """One sentence on how the model fares, as far as the reference's noise lets us see."""
    metrics, floors = case["metrics"], case["noise_floor"]
    error, floor = metrics["relative_l1"], floors["relative_l1"]
    if error is None:
        return "The reference is black: there is nothing to be relative to."
    if floor is None:
        return f"{form(error, 'percent')} from the reference, whose noise is not known."
    noise = form(floor, "percent")
    if error > 1.1 * floor:
        return f"{form(metrics['relative_l1_corrected'], 'percent')} off, the reference's noise of {noise} taken out."
    blocks, block_floor = metrics["relative_l1_blocks"], floors["relative_l1_blocks"]
    if blocks <= 1.25 * block_floor:
        return f"Within the reference's own noise: {noise} in a pixel, {form(block_floor, 'percent')} in 8×8 blocks."
    off = form(metrics["relative_l1_blocks_corrected"], "percent")
    return f"Within the reference's noise of {noise} in a pixel; {off} off in 8×8 blocks, where the noise is low."


def form(value, how):
    """A number as a reader wants it: three significant digits."""
    if value is None:
        return "–"
    if isinstance(value, list):
        return ", ".join(str(part) for part in value)
    if how == "percent":
        return f"{_digits(100.0 * value)} %"
    if how == "ratio":
        return f"{value:.4f}"
    return _digits(value)


def _digits(value):
    if value == 0.0:
        return "0"
    size = abs(value)
    if size < 1e-3 or size >= 1e5:
        return f"{value:.2e}"
    places = max(0, 2 - int(numpy.floor(numpy.log10(size))))
    return f"{value:.{places}f}"


def _colour_tables():
    def octets(table):
        return numpy.rint(255.0 * table).astype(int).ravel().tolist()

    return json.dumps(
        {
            "sequential": octets(colours.SEQUENTIAL),
            "diverging": octets(colours.DIVERGING),
            "errorRange": colours.ERROR_RANGE,
            "signedRange": colours.SIGNED_RANGE,
        },
        separators=(",", ":"),
    )


def _gradient(table):
    """CSS stops of a colour table."""
    return ", ".join("rgb({:.0f} {:.0f} {:.0f})".format(*(255.0 * colour)) for colour in table[::15])

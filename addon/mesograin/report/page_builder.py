# Puts results, pictures, plots, style and script into one HTML file that needs nothing else.
"""See `build`."""

import hashlib
import json
from pathlib import Path

import jinja2
import numpy
from markupsafe import Markup

from ..cycles.wording import TRACERS, in_labels
from ..schema.labels import boundary, of_model
from . import colours, payload, plots
from .wording import (case_terms, case_title, compared, controls, form, headline, label, mask_steps, metric, parameters,
                      significance, terms, until, verdict)

PAGE = Path(__file__).resolve().parent / "page"
PLOTS = "plots"
"""The folder beside the page that holds its plots as files."""

LIVE_BUDGET = 48 * 2**20
"""Characters of packed pictures in one page; cases beyond it are shown as still pictures."""

# The numbers that lead the table and each case, with how to write them: (key, title, form).
LEADING = tuple((key, label(key), how) for key, how in (
    ("metrics.relative_l1_blocks_corrected", "percent"),
    ("metrics.relative_l1_blocks", "percent"),
    ("metrics.relative_l1_corrected", "percent"),
    ("metrics.relative_l1", "percent"),
    ("noise_floor.relative_l1", "percent"),
    ("our_noise.relative_l1", "percent"),
    ("significance.share", "percent"),
    ("metrics.bias", "ratio"),
    ("metrics.rse_mean", "number"),
    ("metrics.rse_max", "number"),
    ("frame_ms", "milliseconds"),
    ("reference_seconds", "seconds"),
))


def build(results, cases, folder):
    """The page's text; its plots are also written into FOLDER/plots, as SVG and PNG. Raises OSError.

    cases: [reading.CasePictures], in the order of results["cases"]."""
    pictures = _Pictures(LIVE_BUDGET)
    views = [_view(of, results, pictures, Path(folder) / PLOTS) for of in cases]
    done = [of for of in cases if of.case["status"] == "done"]
    rows = [(of.case, of.model, of.reference, of.mask) for of in done]
    return render(
        "report.html.j2",
        results=results,
        cases=views,
        leading=[
            {"key": key, "title": title, "form": how, "definition": definition(results["definitions"], key)}
            for key, title, how in LEADING
        ],
        cost=plot(plots.cost([of.case for of in done]), Path(folder) / PLOTS, "cost",
                  terms(results)),
        overview=_files(plots.overview(rows, terms(results)), Path(folder) / PLOTS, "overview"),
        pictures=pictures.texts,
        script=Markup((PAGE / "report.js").read_text(encoding="utf-8")),
        colour_tables=Markup(_colour_tables()),
        sequential=_gradient(colours.SEQUENTIAL),
        diverging=_gradient(colours.DIVERGING),
        scores=_gradient(colours.score_colour(numpy.linspace(-2.5, 2.5, 601), 1.0)),
        not_finite="rgb({:.0f} {:.0f} {:.0f})".format(*(255.0 * part for part in colours.NOT_FINITE)),
    )


def render(template, **values):
    """The text of a page: a template of the folder `page`, in the house's style."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(PAGE),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
    )
    environment.filters["form"] = form
    environment.filters["label"] = label
    styles = {
        "style": Markup((PAGE / "report.css").read_text(encoding="utf-8")),
        "common_script": Markup((PAGE / "common.js").read_text(encoding="utf-8")),
    }
    return environment.get_template(template).render(**styles, **values)


def plot(draw, folder, name, said=()):
    """A plot in the page and in the folder of plots, there with what is said below it: {"svg": Markup, "files": [path
    from the page]}; or None."""
    svg = plots.page(draw)
    if not svg:
        return None
    return {"svg": Markup(svg), "files": _files(draw, folder, name, said)}


def _files(draw, folder, name, said=()):
    """Saves a plot; returns its files as the page links them."""
    return [f"{folder.name}/{file}" for file in plots.save(draw, folder, name, said)]


class _Pictures:
    """Linear pictures packed into the page, each once however many cases show it, up to a budget of characters."""

    def __init__(self, budget):
        self.texts = {}
        self._left = budget

    def add(self, pixels):
        """The picture's name in the page; None if the budget is spent."""
        text = payload.pack(pixels)
        name = "p" + hashlib.sha256(text.encode()).hexdigest()[:12]
        if name not in self.texts:
            if len(text) > self._left:
                return None
            self._left -= len(text)
            self.texts[name] = text
        return name


def _view(of, results, pictures, folder):
    """What the template needs of one case. of: reading.CasePictures."""
    case, definitions = of.case, results["definitions"]
    view = {"case": case, "done": case["status"] == "done", "parameters": parameters(case["material"]),
            "model": of_model(case["model"]), "title": case_title(case)}
    if not view["done"]:
        view["error"] = in_labels(case["error"])
        return view
    view["boundary"] = boundary(case)
    view["tracer"] = TRACERS[case["reference"]]
    view["notes"] = [in_labels(note) for note in case["notes"]]
    view["png"] = of.png
    height, width = of.model.shape[:2]
    live = {
        "model": pictures.add(of.model[..., :3]),
        "reference": pictures.add(of.reference[..., :3]),
        "mask": pictures.add(of.mask[..., None]),
    }
    size = {"width": width, "height": height, "stops": case["exposure_stops"]}
    view["scored"] = of.scores is not None
    if view["scored"]:
        live["scores"] = pictures.add(of.scores[..., None])
        size["threshold"] = case["significance"]["score_threshold"]
    view["live"] = None if None in live.values() else Markup(json.dumps({**size, **live}))
    relative = colours.relative_error(of.model, of.reference)
    said = case_terms(results, case)
    view["plots"] = [
        (title, made)
        for title, made in (
            (
                "Radiance along the steepest line",
                plot(plots.profile(of.model, of.reference, of.noise), folder, f"{case['name']}.profile", said),
            ),
            (
                "Radiance over the angle to the light",
                plot(plots.by_angle(case.get("profile")), folder, f"{case['name']}.by_angle", said),
            ),
            (
                "Distribution of the relative error",
                plot(plots.histogram(relative, of.mask), folder, f"{case['name']}.histogram", said),
            ),
        )
        if made
    ]
    view["numbers"] = [
        {
            "key": key,
            "title": title,
            "text": form(look_up(case, key), how),
            "value": look_up(case, key),
            "definition": definition(definitions, key),
        }
        for key, title, how in LEADING
    ]
    view["others"] = [
        {
            "title": metric(name),
            "text": form(value, "number"),
            "floor": form(case["noise_floor"].get(name), "number"),
            "unfiltered": form(look_up(case, f"unfiltered.metrics.{name}"), "number"),
            "definition": definitions.get(name, ""),
        }
        for name, value in case["metrics"].items()
    ]
    view["verdict"] = verdict(case)
    view["significance"] = significance(case)
    view["controls"] = controls(case)
    view["compared"] = compared(case["mask"], of.mask.size)
    unfiltered = look_up(case, "unfiltered.metrics.relative_l1")
    view["unfiltered"] = None if unfiltered is None else form(unfiltered, "percent")
    view["mask_steps"] = mask_steps(case)
    view["until"] = until(case)
    view["leading"] = next(number for number in view["numbers"] if number["key"] == headline(case))
    return view


def look_up(case, key):
    """A value by its dotted path; None if there is none."""
    value = case
    for part in key.split("."):
        value = value.get(part) if isinstance(value, dict) else None
    return value


def definition(definitions, key):
    """The sentence for a number by its dotted path; "" if there is none."""
    group, _, name = key.rpartition(".")
    if group in ("noise_floor", "our_noise") and group in definitions:
        return f"{definitions[group]}; here for {metric(name)}: {definitions.get(name, '')}"
    return definitions.get(name) or definitions.get(key, "")


def _colour_tables():
    def octets(table):
        return numpy.rint(255.0 * table).astype(int).ravel().tolist()

    return json.dumps(
        {
            "sequential": octets(colours.SEQUENTIAL),
            "diverging": octets(colours.DIVERGING),
            "errorRange": colours.ERROR_RANGE,
            "signedRange": colours.SIGNED_RANGE,
            "notFinite": octets(numpy.array(colours.NOT_FINITE)),
        },
        separators=(",", ":"),
    )


def _gradient(table):
    """CSS stops of a colour table."""
    return ", ".join("rgb({:.0f} {:.0f} {:.0f})".format(*(255.0 * colour)) for colour in table[::15])

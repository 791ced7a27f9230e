"""What bench heap_light has found, for readers: an HTML page with pictures, and a table in markdown."""
import base64
import io
import pathlib

import jinja2
import markupsafe
import numpy

HERE = pathlib.Path(__file__).resolve().parent
# Relative L1 in blocks that is asked for, by how a heap is drawn; and how far totals may be off.
BOUNDS = {"blocks": {"order_1": 0.04, "gathered": 0.025}, "low": {"order_1": 0.07, "gathered": 0.05},
          "refracting": {"order_1": 0.08, "heaps": 0.08, "gathered": 0.08}, "total": 0.03}


def bound(case):
    """Of its error in blocks; None without light between grains."""
    row = "refracting" if case["refracts"] else "low" if case["light"] == "low" else "blocks"
    return BOUNDS[row].get(case["exchange"])


def _marked(case, met):
    return "" if bound(case) is None else markupsafe.Markup(f' class="{"met" if met else "missed"}"')


def png(picture, exposure):
    """Base64 of linear radiance as sRGB."""
    import matplotlib.image

    linear = numpy.clip(picture * exposure, 0.0, 1.0)
    data = io.BytesIO()
    matplotlib.image.imsave(data, numpy.where(linear < 0.0031308, 12.92 * linear,
                                              1.055 * linear ** (1.0 / 2.4) - 0.055), format="png")
    return base64.b64encode(data.getvalue()).decode()


def pictures_of(kind, light, truth, drawn):
    """One row of pictures. truth: (h, w, 3); drawn: [(title, (h, w, 3))]."""
    exposure = 0.9 / max(float(numpy.percentile(truth, 98.0)), 1e-9)
    shown = [("path traced", png(truth, exposure))]
    for title, picture in drawn:
        error = (picture - truth).mean(axis=-1, keepdims=True) * exposure
        shown += [(title, png(picture, exposure)),
                  (f"{title} less the truth; full red or blue: a fifth of white",
                   png(_signed(5.0 * error), 1.0))]
    return {"kind": kind, "light": light, "pictures": shown}


def _signed(error):
    """White where nothing differs, red where it is too bright, blue where too dark."""
    bright, dark = numpy.clip(error, 0.0, 1.0), numpy.clip(-error, 0.0, 1.0)
    return numpy.concatenate((1.0 - dark, 1.0 - dark - bright, 1.0 - bright), axis=-1).clip(0.0, 1.0)


def html(cases, pictures, **about):
    """The page. about: spheres, size, samples, paths."""
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE), trim_blocks=True, lstrip_blocks=True,
                                     keep_trailing_newline=True, autoescape=True, undefined=jinja2.StrictUndefined)
    environment.filters["percent"] = lambda value: f"{100.0 * value:.1f}"
    environment.filters["total_met"] = lambda case: _marked(case, abs(case["total"] - 1.0) <= BOUNDS["total"])
    environment.filters["blocks_met"] = lambda case: _marked(case, case["blocks"] <= (bound(case) or 0.0))
    wide = any(case["refracts"] and case["light"] != "sky" for case in cases)
    return environment.get_template("heap_light.html.j2").render(cases=cases, pictures=pictures, bounds=BOUNDS,
                                                                 wide=wide, **about)


def markdown(cases):
    lines = ["| grains | light | model | exchange | total | blocks | truth's noise |", "|---|---|---|---|---|---|---|"]
    lines += [f"| {case['kind']} | {case['light']} | {case['model']} | `{case['exchange']}` | {case['total']:.3f} |"
              f" {case['blocks']:.1%} | {case['truth_noise']:.1%} |" for case in cases]
    return "\n".join(lines) + "\n"

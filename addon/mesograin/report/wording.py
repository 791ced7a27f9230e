# How numbers, parameters and results are put into words on the page.
"""See `form`, `parameters` and `verdict`."""

import math

from ..cycles.wording import LABELS
from ..schema.labels import boundary, of_model

METRICS = {
    "relative_l1": "relative L1",
    "bias": "bias",
    "rse_mean": "mean RSE",
    "rse_max": "max RSE",
    "rse_max_at": "place of max RSE",
    "rse_root_mean": "mean root RSE",
    "rae_mean": "mean RAE",
    "ae_mean": "mean AE",
    "e_mean": "mean E",
    "se_mean": "mean SE",
    "mse": "MSE",
    "rmse": "RMSE",
    "max_error": "max AE",
    "max_error_at": "place of max AE",
    **{f"{name}_p{share}": f"{name.upper()}, {share} %" for name in ("ae", "rse") for share in (50, 95, 99)},
}
"""What pages and figures call the metrics of docs/metrics.md."""

SUFFIXES = {"_corrected": ", noise taken off", "_blocks": " in 8×8 blocks"}

NUMBERS = {
    "noise_floor": "noise floor",
    "our_noise": "our own noise",
    "significance.verdict": "verdict",
    "significance.share": "significant pixels",
    "mask.pixels": "pixels compared",
    "mask.nan": "NaN",
    "mask.inf": "Inf",
    "mask_steps": "masks",
    "judged_by": "number to read first",
    "profile": "radiance over the angle to the light",
    "frame_ms": "ms a frame",
    "reference_seconds": "Cycles, s",
    "exposure_stops": "exposure",
    "samples": "samples a pixel",
    "milliseconds": "time, ms",
    "further_ms": "ms a further sample",
    "exchange_ms": "ms of light between grains",
}
"""What pages call other numbers of a result, by dotted paths, where that is not their key."""


def label(key):
    """What pages call a number by its dotted path, or all numbers of a group."""
    group, _, name = key.rpartition(".")
    return NUMBERS.get(key) or NUMBERS.get(group) or metric(name)


def metric(name):
    """A metric as pages and figures call it, with what its suffixes say. A name that is no metric's stays."""
    for suffix, meaning in SUFFIXES.items():
        if name.endswith(suffix):
            return metric(name[:-len(suffix)]) + meaning
    return METRICS.get(name, name)


def parameters(material):
    """[(material name, [(parameter, text)])]."""
    return [
        (name, [(parameter, _text(value)) for parameter, value in values.items()]) for name, values in material.items()
    ]


def _text(value):
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, str):
        return LABELS.get(value, value)
    if isinstance(value, list):
        parts = [f"{number:.4g}" for number in value]
        return parts[0] if len(set(parts)) == 1 else ", ".join(parts)
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def case_title(case):
    """What a case is called: its model and what it is against."""
    part = case.get("part", "whole")
    return f"{of_model(case['model'])} against {case['reference_title']}" + (
        "" if part == "whole" else f", {part} part alone")


def headline(case):
    """The key of the number to read first: how far off is what noise does not explain, if that is known."""
    metric = "relative_l1_blocks"
    corrected = case["metrics"].get(f"{metric}_corrected")
    return f"metrics.{metric}" if corrected is None else f"metrics.{metric}_corrected"


def terms(results):
    """What a figure must say of a comparison to be read alone: [sentence]."""
    done = [case for case in results["cases"] if case["status"] == "done"]
    references = dict.fromkeys(
        case["reference_title"] + (f" (boundary {boundary(case)})" if case["boundary"] else "") for case in done
    )
    floors = [case["noise_floor"]["relative_l1"] for case in done if case["noise_floor"]["relative_l1"] is not None]
    noise = "not known"
    if floors:
        low, high = (form(value, "percent") for value in (min(floors), max(floors)))
        noise = low if low == high else f"{low} to {high}"
    return [
        f"{results['scene']}, {results['size'][0]} × {results['size'][1]} pixels, against {'; '.join(references)}.",
        f"Linear radiance, W m⁻² sr⁻¹; errors are relative L1. The references' own noise in a pixel: {noise}.",
    ]


def case_terms(results, case):
    """`terms` for a figure of one case."""
    against, _ = terms({**results, "cases": [case]})
    noise = form(case["noise_floor"]["relative_l1"], "percent")
    return [f"{of_model(case['model'])}: {against}",
            "Linear radiance, W m⁻² sr⁻¹. The reference's own noise in a pixel, relative L1: "
            f"{'not known' if noise == '–' else noise}."]


def verdict(case):
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


def significance(case):
    """What the significance test says, in a sentence; "" where there was none."""
    found = case.get("significance")
    if not found:
        return ""
    seeds = f"{found['reference_seeds']} seeds of the reference and {found['our_seeds']} of ours"
    if found["verdict"] != "differs":
        rate = form(found["false_alarm_rate"], "percent")
        return f"No significant difference in {found['pixels']} pixels, false-alarm rate {rate}; {seeds}."
    places = f"{form(found['share'], 'percent')} of {found['pixels']} pixels"
    if found.get("blocks"):
        places += f" and {form(found['share_blocks'], 'percent')} of {found['blocks']} blocks of 8×8"
    return f"Differs significantly in {places}; {seeds}."


def controls(case):
    """What the test says where the truth is known: [(whether it is right, sentence)]; empty if that was not asked."""
    found = case.get("controls")
    if not found:
        return []
    change = ", ".join(f"{name} {_text(value)}" for name, value in found["wrong"]["change"].items())
    told = []
    for name, what, expected in (("identical", "The same material with other seeds", "no significant difference"),
                                 ("wrong", f"A wrong one, {change},", "differs")):
        test = found[name]
        where = f"{form(test['share'], 'percent')} of the pixels"
        if test["share_blocks"] is not None:
            where += f" and {form(test['share_blocks'], 'percent')} of the blocks"
        verdict = f"is called different in {where}" if test["verdict"] == "differs" else "is not called different"
        told.append((test["verdict"] == expected, f"{what} {verdict}."))
    return told


def compared(mask, pixels):
    """How many pixels were compared, and what took the others away. mask: of results.json, pixels: of the picture."""
    away = [f"{pixels - mask['pixels']} by the mask ({mask['source']})"]
    away += [f"{mask[name]} by {title}" for name, title in (("nan", "NaN"), ("inf", "Inf")) if mask[name]]
    return f"{mask['pixels'] - mask['nan'] - mask['inf']} of {pixels}; taken away: {', '.join(away)}"


def mask_steps(case):
    """[sentence] of what each mask took away, one after the other."""
    steps = case.get("mask_steps", ())
    return [f"{step['name']} took {step['removed']} away and kept {step['pixels']}" for step in steps]


def until(case):
    """What adding seeds until the noise was small came to, in a sentence; "" if that was not asked for."""
    found = case.get("until")
    if not found:
        return ""
    ratio = "not known" if found["ratio"] is None else form(found["ratio"], "number")
    end = "" if found["reached"] else f"; {found['most_seeds']} seeds were not enough"
    return (
        f"Seeds were added until noise was {form(found['fraction'], 'number')} of the error in"
        f" {metric(found['metric'])}: it is {ratio} of it{end}."
    )


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
    places = max(0, 2 - int(math.floor(math.log10(size))))
    return f"{value:.{places}f}"


def times(ratio):
    """'1.7×', '53×', '3400×', '17 000×': two significant digits."""
    if ratio < 9.95:
        return f"{ratio:.1f}×"
    rounded = round(ratio, 1 - math.floor(math.log10(ratio)))
    return (f"{rounded:,.0f}".replace(",", "\u202f") if rounded >= 10000 else f"{rounded:.0f}") + "×"


def duration(milliseconds):
    """'12 ms', '4.1 s', '41 s', '3 min 05 s'."""
    if milliseconds < 999.5:
        return f"{milliseconds:.2g} ms" if milliseconds < 9.95 else f"{milliseconds:.0f} ms"
    seconds = milliseconds / 1000.0
    if seconds < 9.95:
        return f"{seconds:.1f} s"
    seconds = round(seconds)
    if seconds < 60:
        return f"{seconds} s"
    return f"{seconds // 60} min {seconds % 60:02d} s" if seconds < 36000 else f"{seconds / 3600.0:.0f} h"

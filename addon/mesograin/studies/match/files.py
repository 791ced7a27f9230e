# What a match comes to, in files and in a sentence.
"""See `write` and `sentence`."""

import json
import os

import numpy

FORMAT = "mesograin-match", 1
RESULTS, RENDERS = "match.json", "renders.jsonl"
PICTURES = {"model": "model.exr", "reference": "target.exr", "error": "error.exr"}
BESIDE = "beside.png"

DEFINITIONS = {
    "sigma_a": "absorption coefficient of R, G and B, for a `scale` of 1, in the unit named",
    "sigma_s": "scattering coefficient of R, G and B, for a `scale` of 1, in the unit named",
    "intervals": "two standard deviations either way, by the picture's derivatives, by what it leaves unexplained and"
    " by the model's own error as far as others imitate it; what is wrong about the scene itself is not in it."
    " determined: the ends of the interval are less than a factor of 3 apart (g: 0.5); bounded: the absorption is not"
    " determined, but its high end is below a tenth of the scattering",
    "exposure": "factor by which the scene's light was multiplied to be as bright as the picture; 1 if it was known",
    "metrics": "of the picture drawn against the target, over the mask (docs/metrics.md)",
    "corrected_blocks": "relative L1 in blocks of the picture times what Cycles' picture of the last coefficients was"
    " brighter there: what is left unexplained; null without corrections",
    "mean_free_path": "reduced: 1 / (sigma_a + (1 - g) sigma_s)",
}


def describe(found, unit, per_unit, settings, **origin):
    """The dict that match.json holds. found: search.Found. unit: of length, such as 'mm'; per_unit: of those in one of
    the scene's. settings: what was asked for; origin: where it comes from."""
    def intervals(name, entries):
        power = {"sigma_a": -1, "sigma_s": -1, "mean_free_path": 1}.get(name, 0)
        factor = per_unit**power
        return [{key: value if isinstance(value, bool) else value * factor for key, value in entry.items()}
                for entry in entries]

    return {
        "format": FORMAT[0],
        "format_version": FORMAT[1],
        "complete": found.converged,
        **origin,
        "settings": settings,
        "model": found.model,
        "unit": f"1/{unit}",
        "sigma_a": [value / per_unit for value in found.coefficients["sigma_a"]],
        "sigma_s": [value / per_unit for value in found.coefficients["sigma_s"]],
        "g": found.coefficients["g"],
        "scale": 1.0,
        "exposure": found.exposure,
        "intervals": {name: intervals(name, entries) for name, entries in found.intervals.items()},
        "converged": found.converged,
        "corrections": found.corrections,
        "corrected_blocks": found.corrected,
        "renders": found.renders,
        "remembered": found.remembered,
        "iterations": found.iterations,
        "metrics": {key: value for key, value in found.metrics.items()
                    if key in ("relative_l1", "relative_l1_blocks", "bias", "rse_mean", "mask")},
        "warnings": list(found.warnings),
        "definitions": DEFINITIONS,
        "files": dict(PICTURES),
    }


def write(native, folder, results, found, provenance_key):
    """Writes match.json and the EXR pictures into a folder that is there. Raises OSError or native.Error."""
    told = {name: results[name] for name in ("sigma_a", "sigma_s", "g", "unit", "exposure", "model")}
    pictures = {"model": found.picture, "reference": found.target,
                "error": native.error_image(found.picture, found.target, metric="e")}
    for name, pixels in pictures.items():
        native.write_exr(str(folder / PICTURES[name]), numpy.ascontiguousarray(pixels, numpy.float32),
                         attributes={provenance_key: json.dumps({"quantity": QUANTITIES[name], **told})})
    partial = folder / f"{RESULTS}.{os.getpid()}.part"
    partial.write_text(json.dumps(results, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    os.replace(partial, folder / RESULTS)


QUANTITIES = {
    "model": "radiance by the coefficients that were found, times the exposure",
    "reference": "the picture that was to be matched, made as small as it was compared",
    "error": "the first less the second",
}


def beside(found, expose):
    """(h, 2 w, 3): the target and, right of it, what was found, by `expose` of each."""
    return numpy.concatenate((expose(found.target), expose(found.picture)), axis=1)


def sentence(results):
    """What was found, in one."""
    unit = results["unit"]
    told = [f"{name} {_numbers(results['intervals'][name])} {unit}" for name in ("sigma_s", "sigma_a")
            if name in results["intervals"]]
    told += [f"{name} {_numbers(results['intervals'][name])}" for name in ("g", "exposure")
             if name in results["intervals"]]
    off = results["metrics"]["relative_l1_blocks"]
    words = f"{', '.join(told)}; the picture is {off:.1%} off in blocks after {results['renders']} renders"
    if results["corrections"]:
        words += f", and {results['corrected_blocks']:.1%} with what Cycles says that our model is off"
    unknown = [f"{name} of {', '.join(channels)}" if len(results["intervals"][name]) == 3 else name
               for name, channels in undetermined(results["intervals"]).items()]
    if unknown:
        words += f"; the picture does not determine {' and '.join(unknown)}"
    return words + ("." if results["converged"] else "; the search did not come to its end.")


def undetermined(intervals):
    """{name: [channels]} of what the picture does not tell."""
    found = {}
    for name, entries in intervals.items():
        unknown = [channel for channel, entry in zip(("red", "green", "blue"), entries) if not entry["determined"]]
        if unknown:
            found[name] = unknown
    return found


def _numbers(entries):
    return ", ".join(number(entry) for entry in entries)


def number(entry):
    """'2.3 (2.2 to 2.4)'; of what is not determined, the value alone, marked, or what it is at most."""
    if entry["bounded"]:
        return f"at most {entry['high']:.2g}"
    if not entry["determined"]:
        return f"{entry['value']:.3g} (not determined)"
    return f"{entry['value']:.3g} ({entry['low']:.3g} to {entry['high']:.3g})"

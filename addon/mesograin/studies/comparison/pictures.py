# A case's pictures: EXR files that hold the data, PNG files to look at.
"""See `write`."""

from ... import __version__, native_module
from ...report import colours
from . import significance

ERROR = "i - r: our image less the mean of the reference's seeds, linear radiance"
NOISE = "standard error of the mean of the reference's seeds, linear radiance"
MASK = "1 where pixels were compared"
SCORES = (
    "difference of the means in standard deviations of it, signed, positive where we are too bright; 0 within the"
    " tolerance"
)


def write(case, found, output, common, ours):
    """Writes the pictures of a Measurement into a `results.Output`; returns {"files", "exposure_stops"}.

    common: provenance of every file, ours: that of our side.
    """
    native = native_module.get()
    image, theirs, mask = found.image, found.theirs, found.mask
    mean = theirs.mean
    common = {"made_by": f"Mesograin {__version__}", **common}
    stops = colours.exposure_for(mean, mask if mask.any() else None)
    shown = mask[..., None]
    relative = colours.relative_error(image, mean)

    def exr(name, pixels, provenance):
        return output.write_exr(f"{case.name}/{name}.exr", pixels, {**common, **provenance})

    def png(name, shown_colours):
        return output.write_png(f"{case.name}/{name}.png", shown_colours)

    files = {
        "model": exr("model", image, ours),
        "reference": exr("reference", mean, {"mean_of": theirs.provenance}),
        "error": exr("error", native.error_image(image, mean, metric="e"), {"definition": ERROR}),
        "mask": exr("mask", mask.astype("float32"), {"definition": MASK}),
        "model_png": png("model", colours.expose(image, stops)),
        "reference_png": png("reference", colours.expose(mean, stops)),
        "error_png": png("error", shown * colours.false_colour(relative)),
        "signed_error_png": png("signed_error", shown * colours.signed_colour(relative)),
    }
    if found.scores is not None:
        verdict = found.numbers["significance"]
        files["noise"] = exr("noise", theirs.standard_error, {"definition": NOISE})
        files["z_map"] = exr("z_map", found.scores, {"definition": SCORES, "significance": verdict})
        score = significance.largest_score(found.scores)
        files["z_map_png"] = png("z_map", shown * colours.score_colour(score, verdict["score_threshold"]))
    return {"files": files, "exposure_stops": stops}

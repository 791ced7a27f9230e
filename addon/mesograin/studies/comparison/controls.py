# Whether the significance test can be believed here: the reference's own renderer stands in our place, right and wrong.
"""See `test`. The same material with other seeds must not be called different, a wrong one must."""

import math

from ...cycles import reference
from . import significance

SEEDS_FROM = 1001
"""Seeds that no reference has, so that the noise is independent."""


def wrong(recipe, materials):
    """{parameter: value}, a deliberately wrong material: of a medium twice its scattering and absorption, of an opaque
    surface half its reflectance, of a reflecting dielectric a higher index. recipe: of `kinds.Kind`. materials:
    {name: {parameter: value}}, of which the largest values count."""
    values = list(materials.values())
    if recipe in ("diffuse", "glossy"):
        brightest = max((each["reflectance"] for each in values), key=sum)
        return {"reflectance": tuple(0.5 * channel for channel in brightest)}
    if recipe == "dielectric_specular":
        return {"eta": 1.1 * max(each["eta"] for each in values)}
    return {"scale": 2.0 * max(each["scale"] for each in values)}


def test(case, request, depsgraph, size, overrides, materials, theirs, mask, progress):
    """The entry `controls` of results.json: {'identical', 'wrong'}, each the entry of `significance.test`, 'wrong' with
    its 'change' beside; None with one seed. theirs: the Reference. The rest as in `measure.measure`.

    Raises ReferenceError, StageError, native.Error or progress.Cancelled.
    """
    progress.begin()
    change = wrong(case.kind.recipe, materials)
    found = {}
    for name, changed, share in (("identical", {}, 0.0), ("wrong", change, 0.5)):
        sampling = reference.Sampling(
            depsgraph, case.reference, size, request.reference_samples, request.cache, {**overrides, **changed},
            part=case.part,
        )
        seeds = range(SEEDS_FROM, SEEDS_FROM + len(theirs.seeds))
        sampling.add(seeds, lambda done, share=share: progress.update(share + 0.5 * done))
        found[name], _ = significance.test(sampling.result().images, theirs.images, mask)
    progress.end(learn=False)
    if found["identical"] is None:
        return None
    return {"identical": found["identical"], "wrong": {**found["wrong"], "change": plain(change)}}


def plain(parameters):
    """The same as JSON has it: with lists for tuples, and null for what is no number."""
    return {name: [_plain(each) for each in value] if isinstance(value, tuple) else _plain(value)
            for name, value in parameters.items()}


def _plain(value):
    return None if isinstance(value, float) and not math.isfinite(value) else value

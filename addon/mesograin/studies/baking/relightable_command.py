# An object baked so that it can be lit anew: what `bake --relightable` does.
"""See `bake`."""

from ... import native_module
from ...cycles.shot import PROVENANCE
from . import relightable, relightable_files, relightable_nodes
from .surface import BakeError, OutputError, Surface


def bake(depsgraph, name, size, samples, overrides, count, output, margin, half, tell):
    """Bakes an object and writes all files beside `output`; returns (relightable.Relightable, sentences).
    tell: called with the share that is done. Raises BakeError, OutputError or native.Error."""
    native = native_module.get()
    # What the surface reflects depends on who looks.
    surface = Surface(depsgraph, name, size, overrides={**overrides, "specular": False}, exchange="off")
    small, large = (surface.lit(sides, samples) for sides in ((relightable.SMALL,) * 2, size))
    made = relightable.bake(small, large, count, tell)
    if not made.errors.size or not (made.coverage > 0.0).any():
        raise BakeError(f"No texel of '{name}' is covered: bake a larger texture.")
    sentences = [*surface.warnings, *large.warnings]
    provenance = {**surface.provenance(margin), "samples": samples}
    try:
        relightable_files.write(native, output, name, made, provenance, PROVENANCE, half)
        relightable_nodes.save(relightable_files.paths(output), f"Relit {name}", count, _eta(surface))
    except (OSError, native.Error, RuntimeError) as error:
        raise OutputError(str(error)) from error
    return made, sentences


def _eta(surface):
    """Of what light leaves through, if that is a surface that refracts, the same everywhere."""
    found = {values["eta"] if values["model"] in REFRACTING and values["boundary"] == "dielectric" else None
             for values in surface.materials.values()}
    return found.pop() if len(found) == 1 else None


REFRACTING = ("model_2", "model_3", "transport")

# An object baked so that it can be lit anew, for the command line and the panel alike.
"""See `RelightableBake`."""

from ... import native_module
from ...cycles.shot import PROVENANCE
from . import relightable, relightable_files, relightable_nodes
from .surface import BakeError, OutputError, Surface


class RelightableBake:
    """An object of an evaluated scene; after the constructor `bake` and `write` may run on any thread, as nothing of
    Blender's is touched.

    depsgraph, name, size, overrides: as of `Surface`. samples: a texel, for each direction. count: of components.
    Raises BakeError or native.Error with one sentence.
    """

    def __init__(self, depsgraph, name, size, samples, count, overrides=None):
        # What the surface reflects depends on who looks.
        self.surface = Surface(depsgraph, name, size, overrides={**(overrides or {}), "specular": False},
                               exchange="off")
        self.samples, self.count = samples, count
        self._small, self._large = (
            self.surface.lit(sides, samples) for sides in ((relightable.SMALL,) * 2, self.surface.size))
        self.made = None
        """The relightable.Relightable, once it was baked."""

    def bake(self, tell=lambda share: None):
        """Lights it from all sides, calling `tell` with the share that is done; returns what `made` holds from then on.
        Raises relightable.Cancelled, BakeError or native.Error."""
        made = relightable.bake(self._small, self._large, self.count, tell)
        if not made.errors.size or not (made.coverage > 0.0).any():
            raise BakeError(f"No texel of '{self.surface.name}' is covered: bake a larger texture.")
        self.made = made
        return made

    def cancel(self):
        """Ends `bake` after its current sample; from any thread."""
        for lit in (self._small, self._large):
            lit.cancel()

    def write(self, output, margin, half):
        """All files of relightable_files.paths but the nodes. Raises OutputError."""
        native = native_module.get()
        provenance = {**self.surface.provenance(margin), "samples": self.samples}
        try:
            relightable_files.write(native, output, self.surface.name, self.made, provenance, PROVENANCE, half)
        except (OSError, native.Error) as error:
            raise OutputError(str(error)) from error

    def write_nodes(self, output):
        """The .blend file, in Blender's own thread, after `write`. Raises OutputError."""
        files = relightable_files.paths(output)
        try:
            relightable_nodes.save(files, f"Relit {self.surface.name}", self.count, self._eta())
        except (OSError, RuntimeError) as error:
            reason = " ".join(str(error).removeprefix("Error: ").split())
            raise OutputError(f"{files['nodes']} cannot be written ({reason}): choose another place for it.") from error

    @property
    def warnings(self):
        """What the scene has and we leave out, and what the model asked for did not draw."""
        return tuple(dict.fromkeys((*self.surface.warnings, *self._large.warnings)))

    def errors_in_words(self):
        return (f"relative L1 {self.made.errors.mean():.2%} on average over {self.made.errors.size} directions, "
                f"{self.made.errors.max():.2%} at worst")

    def _eta(self):
        """Of what light leaves through, if that is a surface that refracts, the same everywhere."""
        found = {values["eta"] if values["model"] in REFRACTING and values["boundary"] == "dielectric" else None
                 for values in self.surface.materials.values()}
        return found.pop() if len(found) == 1 else None


REFRACTING = ("model_2", "model_3", "transport")

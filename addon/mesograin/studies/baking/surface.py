# Our side of a bake: one object of a scene, unwrapped at its UVs and shaded by Mesograin.
"""See `Surface`. The user's file is read, never written."""

import dataclasses
import json
import tempfile
import time
from pathlib import Path

import numpy

from ... import __version__, native_module
from ...cycles import kinds
from ...cycles.shot import PROVENANCE
from ...scene import export, meshes
from ..comparison.results import OutputError
from .choices import VIEW_FROM
from .relightable import Lit

CONVENTION = "u to the right, v up, (0, 0) at the lower left corner; row 0 is v = 1"


PATIENCE_SECONDS = 0.1
"""About as long as progress may stand still."""


class BakeError(Exception):
    """The object cannot be baked; one sentence."""


class Surface:
    """An object of an evaluated scene, ready to bake; after the constructor nothing of Blender's is touched, so that
    `render` may run on any thread.

    depsgraph: evaluated. name: of the object; its first instance counts. size: (width, height) in texels.
    view_from: of VIEW_FROM. overrides: {parameter: value} for every material, coefficients per scene unit.
    parts: of independent noise that the texture is the mean of, so that its noise is known. exchange: of the schema's
    choices, or None for the scene's own.
    Raises BakeError or native.Error with one sentence.
    """

    def __init__(self, depsgraph, name, size, view_from=VIEW_FROM[0], overrides=None, parts=1,
                 exchange=None):
        native = native_module.get()
        scene = export.read_scene(depsgraph, meshes.MeshCache(), unwrapped=name)
        instances = _instances(scene, name)
        if any(scene.instances[index].broken_uvs for index in instances):
            raise BakeError(f"Object '{name}' has UVs that are no numbers: unwrap it anew (UV > Unwrap in Edit Mode).")
        if not all(scene.instances[index].mesh.has_uvs for index in instances):
            raise BakeError(f"Object '{name}' has no UVs to bake at: unwrap it (UV > Unwrap in Edit Mode).")
        scene = scene.with_materials(lambda material: _with(material, overrides or {}))
        if exchange:
            scene = dataclasses.replace(scene, exchange=exchange)
        scene = scene.with_models_chosen()
        changed = scene.instances
        self.name, self.size, self.view_from = name, tuple(size), view_from
        self.materials = {changed[index].material.name: dict(changed[index].material.values) for index in instances}
        self.triangles = sum(changed[index].mesh.triangle_count for index in instances)
        self._instances = [changed[index] for index in instances]
        self._views = [native.View(*size, seed=seed) for seed in range(parts)]
        drawn = scene.to_native()
        for view in self._views:
            view.set_scene(drawn)
            if view_from == "active_camera":
                view.set_camera(export.camera_from_scene(depsgraph, *_picture_size(depsgraph.scene)))
            view.set_bake(instances, view_from)
        use = self._views[0].uv_use()
        self.warnings = (*scene.warnings, *(f"Object '{name}': {sentence}" for sentence in use.pop("warnings")))
        self.uv_use = use
        self._cancelled = False

    def render(self, samples, on_progress=None):
        """Brings the texture to `samples` a texel or, where its parts cannot share them alike, a few more, calling
        on_progress with the fraction done; ends early once `cancel` is called. Returns whether it was finished."""
        tell = on_progress or (lambda fraction: None)
        of_each = -(-samples // len(self._views))
        share = 1
        while self._views[-1].samples < of_each and not self._cancelled:
            started = time.monotonic()
            step = min(share, of_each - self._views[-1].samples)
            for view in self._views:
                if not self._cancelled:
                    view.render(step)
            tell(self._views[-1].samples / of_each)
            if time.monotonic() - started < PATIENCE_SECONDS:
                share *= 2
        return not self._cancelled

    def lit(self, size, samples):
        """A relightable.Lit of the object alone, told directions in the object's space."""
        native = native_module.get()
        materials = {values: values.to_native(native) for values in {each.material for each in self._instances}}
        instances = [each.to_native(native, materials[each.material]) for each in self._instances]
        to_world = numpy.array(self._instances[0].object_to_world).reshape(4, 4)[:3, :3]
        return Lit(native, instances, to_world, size, samples)

    @property
    def drawn_otherwise(self):
        """One sentence for each thing in the texture that the model asked for did not draw; known after `render`."""
        return self._views[0].warnings

    @property
    def awaited(self):
        """(what, share done) of what the first sample waits for, as native.View's `awaited` and `preparing`; None if
        that is nothing."""
        views = self._views  # which another thread may let go
        share = views[0].preparing if views else None
        return None if share is None else (views[0].awaited, share)

    def cancel(self):
        """Ends `render` after its current sample; from any thread."""
        self._cancelled = True
        for view in self._views:
            view.cancel()

    def let_go(self):
        """Gives the device's memory back; nothing can be rendered or read any more."""
        self._views = []

    @property
    def samples(self):
        """A texel, over all parts."""
        return sum(view.samples for view in self._views)

    def timings(self):
        """((pass, milliseconds), ...) of the last sample."""
        return tuple((timing["pass"], timing["milliseconds"]) for timing in self._views[0].timings())

    def parts(self):
        """The parts of independent noise, each as `texture` without a margin, and not looked at for NaN and Inf."""
        return [view.read() for view in self._views]

    def texture(self, margin=0):
        """(h, w, 4) float32: linear radiance, premultiplied by the coverage in the last channel, row 0 at v = 1, charts
        grown by `margin` texels. Raises BakeError if a texel is NaN or Inf."""
        mean = numpy.mean(self.parts(), axis=0, dtype=numpy.float64).astype(numpy.float32)
        texture = native_module.get().extend_margin(mean, margin)
        broken = int(numpy.count_nonzero(~numpy.isfinite(texture).all(axis=2)))
        if broken:
            raise BakeError(f"{broken} texels of '{self.name}' are not finite: check its normals and materials.")
        return texture

    def provenance(self, margin=0):
        """What the header of the texture's file says, JSON-able."""
        native = native_module.get()
        return json.loads(json.dumps({
            "made_by": f"Mesograin {__version__}",
            "object": self.name,
            "samples": self.samples,
            "materials": self.materials,
            "view_from": self.view_from,
            "margin": margin,
            "uv": CONVENTION,
            "uv_use": self.uv_use,
            "pixel_filter": "box, one texel",
            "colour_space": "linear, scene-referred; alpha is coverage, premultiplied",
            "units": "coefficients per scene unit; texels are radiance",
            "device": native.device_info()["renderer"],
        }))


def require_writable(path):
    """Raises OutputError if nothing can be written there; for asking before the work rather than after."""
    try:
        with tempfile.TemporaryFile(dir=Path(path).absolute().parent):
            pass
    except OSError as error:
        raise OutputError(f"{path} cannot be written ({error.strerror}): choose another place for it.") from error


def write(path, texture, provenance, half=False):
    """Writes a texture to an EXR file, which appears complete or not at all. half: 16-bit instead of 32-bit floats.
    Raises BakeError if half cannot hold it, OutputError if the place cannot be written."""
    largest = float(texture[..., :3].max())
    if half and largest > HALF_LARGEST:
        raise BakeError(f"16-bit floats hold radiance up to {HALF_LARGEST:g}; the largest is {largest:g}: use 32 bits.")
    native = native_module.get()
    try:
        native.write_exr(path, texture, attributes={PROVENANCE: json.dumps(provenance)}, half=half)
    except native.Error as error:
        raise OutputError(str(error)) from error


HALF_LARGEST = 65504.0


def bakeable(depsgraph):
    """Names of the objects that can be baked, in the order of the scene: those with faces."""
    scene = export.read_scene(depsgraph, meshes.MeshCache())
    return tuple(dict.fromkeys(instance.name for instance in scene.instances))


def choose(depsgraph, name=None):
    """The object to bake: `name`, else the active object, else the only one there is. Raises BakeError."""
    names = bakeable(depsgraph)
    if name is None:
        active = depsgraph.view_layer_eval.objects.active
        name = active.name if active is not None and active.name in names else names[0] if len(names) == 1 else None
    if name in names:
        return name
    if name is None:
        raise BakeError(f"Name the object to bake; {_there_are(names)}.")
    raise BakeError(f"There is no object '{name}' to bake, visible in renders and with faces; {_there_are(names)}.")


def choose_active(depsgraph):
    """The active object, as a button's label says it; the only one there is where none is active. Raises BakeError."""
    active = depsgraph.view_layer_eval.objects.active
    names = bakeable(depsgraph)
    if active is None and len(names) == 1:
        return names[0]
    if active is None:
        raise BakeError(f"Select the object to bake; {_there_are(names)}.")
    if active.name not in names:
        raise BakeError(f"'{active.name}' has no faces of its own that renders show: select what has; "
                        f"{_there_are(names)}.")
    return active.name


def _there_are(names):
    return "there are: " + (", ".join(f"'{name}'" for name in names) or "none")


def _instances(scene, name):
    """Indices of the instances that make up the first placing of an object: one for each material
    slot in use, or for each grain of one."""
    placings = {}
    for index, instance in enumerate(scene.instances):
        if instance.name == name:
            placings.setdefault(instance.object_to_world, []).append(index)
    if not placings:
        raise BakeError(f"There is no object '{name}' to bake, visible in renders and with faces.")
    return next(iter(placings.values()))


def _with(material, overrides):
    values = dict(material.values)
    values.update(kinds.of_material(overrides, values))
    return dataclasses.replace(material, values=tuple(values.items()))


def _picture_size(scene):
    """Of the camera's picture, which fixes nothing but where a perspective camera is."""
    return scene.render.resolution_x, scene.render.resolution_y

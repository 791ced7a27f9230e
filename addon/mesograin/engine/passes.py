# The passes of a final render beside the picture: where rays through the pixels' middles meet what, facing where, whose
# they are, and what the picture's light is made of.
import operator
import typing

import bpy
import numpy as np

from .. import compat
from ..scene import properties
from . import identities

NOWHERE = 1e10
"""Depth where nothing is seen, as Cycles has it."""


class Pass(typing.NamedTuple):
    """A pass as Blender knows it. asked_for: the view layer's property."""

    name: str
    asked_for: str
    channels: str
    kind: str
    label: str = ""

    @property
    def shown(self):
        return self.label or self.name


DEPTH = Pass("Depth", "use_pass_z", "Z", "VALUE")
POSITION = Pass("Position", "use_pass_position", "XYZ", "VECTOR")
NORMAL = Pass("Normal", "use_pass_normal", "XYZ", "VECTOR")
_INDEX_NAMES = compat.names_of_index_passes()
OBJECT_INDEX = Pass(_INDEX_NAMES[0], "use_pass_object_index", "X", "VALUE", "Object Index")
MATERIAL_INDEX = Pass(_INDEX_NAMES[1], "use_pass_material_index", "X", "VALUE", "Material Index")
SAMPLE_COUNT = Pass("Debug Sample Count", "cycles.pass_debug_sample_count", "X", "VALUE", "Sample Count")
DENOISING_NORMAL = Pass("Denoising Normal", "cycles.denoising_store_passes", "XYZ", "VECTOR")
DENOISING_ALBEDO = Pass("Denoising Albedo", "cycles.denoising_store_passes", "RGB", "COLOR")
SURFACES, INDICES = (DEPTH, POSITION, NORMAL), (OBJECT_INDEX, MATERIAL_INDEX)
DENOISING = (DENOISING_NORMAL, DENOISING_ALBEDO)
PORTIONS = {
    **{name: Pass(name.replace("_", " ").title(), f"mesograin.use_pass_{name}", "RGB", "COLOR")
       for name in properties.PORTIONS},
    # In the panel it would be cut off in Blender 5's letters.
    "single_scattering": Pass("Single Scattering", "mesograin.use_pass_single_scattering", "RGB", "COLOR",
                              "Single Scatter"),
    "emission": Pass("Emit", "use_pass_emit", "RGB", "COLOR", "Emission"),
    "environment": Pass("Env", "use_pass_environment", "RGB", "COLOR", "Environment"),
}
"""Of the picture's light, by the native module's names: their sum is the picture."""
PASSES = (*SURFACES, *INDICES, SAMPLE_COUNT, *DENOISING, *PORTIONS.values())


class Matte(typing.NamedTuple):
    """A Cryptomatte as Blender knows it, of several passes. of: which of a thing's names it tells."""

    name: str
    asked_for: str
    of: int
    label: str


MATTES = (Matte("CryptoObject", "use_pass_cryptomatte_object", 0, "Object"),
          Matte("CryptoMaterial", "use_pass_cryptomatte_material", 1, "Material"))


def is_asked_for(view_layer, one):
    """Whether a view layer asks for a Pass or Matte; what this Blender does not have is asked for by none."""
    try:
        return operator.attrgetter(one.asked_for)(view_layer)
    except AttributeError:
        return False


def of(view_layer):
    """Every Pass that a view layer asks for, those of its Cryptomattes too."""
    found = [one for one in PASSES if is_asked_for(view_layer, one)]
    for matte in _mattes(view_layer):
        # In small letters, which files never round to half floats nor take for colours.
        found += [Pass(f"{matte.name}{number:02d}", matte.asked_for, "rgba", "COLOR")
                  for number in range(_ranks(view_layer) // 2)]
    return tuple(found)


def _mattes(view_layer):
    return [matte for matte in MATTES if is_asked_for(view_layer, matte)]


def _ranks(view_layer):
    """How many names a pixel may have; two of them are a pass."""
    return (view_layer.pass_cryptomatte_depth + 1) // 2 * 2


def tell_compositor(engine, scene, view_layer):
    """Has the compositor's Render Layers node show them."""
    for one in of(view_layer):
        engine.register_pass(scene, view_layer, one.name, len(one.channels), one.channels, one.kind)


def add(engine, view_layer):
    """Makes room for them in the picture that is begun next."""
    for one in of(view_layer):
        engine.add_pass(one.name, len(one.channels), one.channels, layer=view_layer.name)


def portions(view_layer):
    """What native.View.set_portions is to be asked for."""
    found = [name for name, one in PORTIONS.items() if is_asked_for(view_layer, one)]
    return [*found, "normal"] if is_asked_for(view_layer, DENOISING_NORMAL) else found


def pixels(view, view_layer, exposure, read_camera, allowed):
    """Yields (name, (h, w, channels) float32 with row 0 at the top), what has to be drawn for it last, of a native.View
    that shows the frame of a motion.Exposure through the native.Camera that `read_camera` gives. allowed: the
    grace.Grace of what has to be drawn."""
    asked = of(view_layer)
    names = {one.name for one in asked}
    if any(one in SURFACES for one in asked):
        yield from _of(names, _surfaces(view, read_camera().world_to_camera))
    if SAMPLE_COUNT in asked:
        yield SAMPLE_COUNT.name, np.full((view.height, view.width, 1), view.samples, dtype=np.float32)
    for name, one in PORTIONS.items():
        if one in asked:
            yield one.name, view.read_portion(name)[..., :3]
    if DENOISING_NORMAL in asked:
        to_camera = read_camera().world_to_camera[:3, :3].astype(np.float32)
        yield DENOISING_NORMAL.name, view.read_portion("normal")[..., :3] @ to_camera.T  # as Cycles has it
        yield DENOISING_ALBEDO.name, identities.albedo(exposure, read_camera, view.width, view.height, allowed)
    if any(one in INDICES for one in asked) or _mattes(view_layer):
        things, numbers = identities.seen(exposure, read_camera, view.width, view.height, allowed)
        yield from _of(names, _indices(things, numbers))
        for matte in _mattes(view_layer):
            yield from _matte(matte, things, numbers, _ranks(view_layer)).items()


def _of(names, found):
    return ((name, each) for name, each in found.items() if name in names)


def _surfaces(view, world_to_camera):
    surfaces = view.read_surfaces()
    places, seen = surfaces["position"][..., :3], surfaces["position"][..., 3] > 0.0
    # Along the camera's axis, not along the ray.
    depth = -(places.astype(np.float64) @ world_to_camera[2, :3] + world_to_camera[2, 3])
    return {POSITION.name: places, NORMAL.name: surfaces["normal"],
            DEPTH.name: np.where(seen, depth, NOWHERE).astype(np.float32)[..., None]}


def _indices(names, numbers):
    """Of what covers most of a pixel."""
    shown = {}
    for one, kept, of_name in ((OBJECT_INDEX, bpy.data.objects, 0), (MATERIAL_INDEX, bpy.data.materials, 1)):
        known = [kept.get(name[of_name]) for name in names]
        indices = np.array([0] + [each.pass_index if each is not None else 0 for each in known], dtype=np.float32)
        most, _ = identities.ranked(numbers, np.arange(len(names) + 1), 1)
        shown[one.name] = indices[most[0]][..., None]
    return shown


def _matte(matte, names, numbers, ranks):
    unique = _unique(matte, names)
    groups = np.array([0] + [1 + unique.index(name[matte.of]) for name in names])
    ids, shares = identities.ranked(numbers, groups, ranks)
    hashes = np.array([0.0] + [identities.id_of(name) for name in unique], dtype=np.float32)
    layers = np.stack((hashes[ids], shares), axis=-1)  # (ranks, h, w, 2)
    return {f"{matte.name}{number:02d}": np.concatenate((layers[2 * number], layers[2 * number + 1]), axis=-1)
            for number in range(ranks // 2)}


def _unique(matte, names):
    return list(dict.fromkeys(name[matte.of] for name in names))


def metadata(view_layer, values):
    """{field: text} that readers of Cryptomattes look for in a picture's file."""
    found = {}
    for matte in _mattes(view_layer):
        name = f"{view_layer.name}.{matte.name}"
        prefix = f"cryptomatte/{identities.hash_of(name):08x}"[:len("cryptomatte/") + 7]
        names = [(drawn.name, drawn.material.name) for drawn in (*values.instances, *values.heaps)]
        found.update({f"{prefix}/name": name, f"{prefix}/hash": "MurmurHash3_32",
                      f"{prefix}/conversion": "uint32_to_float32",
                      f"{prefix}/manifest": identities.manifest(_unique(matte, names))})
    return found

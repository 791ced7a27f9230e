# Blender's scenes and images as what is matched and what it is matched to.
"""See `subject` and `target`."""

import dataclasses
from pathlib import Path

import bpy
import numpy

from ... import native_module
from ...cycles import kinds, nodes, reference
from ...scene import export, lights, meshes
from ...schema.models import AUTO, TRANSLUCENT
from . import target as targets
from .subject import Subject, SubjectError, cut

PROPORTIONS = 0.01
"""By which a picture's may differ from the scene's."""
CODED, LINEAR = ("sRGB",), ("Non-Color", "Raw", "Linear", "Linear Rec.709", "scene_linear")
OPAQUE = 0.99
TRACED_SEEDS = (4,)
"""Other than those of references, whose noise a match would take for agreement."""


def target(image):
    """The target.Target of a bpy.types.Image. Raises TargetError."""
    path = Path(bpy.path.abspath(image.filepath, library=image.library))
    # Of a file with several layers Blender gives no pixels away.
    if image.source == "FILE" and not image.packed_file and not image.is_dirty and path.suffix.lower() == ".exr":
        return targets.read(native_module.get(), path)
    width, height = image.size
    if image.type == "RENDER_RESULT" or not width or not height or image.channels < 3:
        what = "is a render result, whose pixels Blender does not give away: save it as OpenEXR and open that" \
            if image.type == "RENDER_RESULT" else "has no pixels in three colours: choose another"
        raise targets.TargetError(f"The image '{image.name}' {what}.")
    pixels = numpy.empty(width * height * image.channels, numpy.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(height, width, image.channels)[::-1]
    space = image.colorspace_settings.name
    if image.is_float or space in LINEAR:
        made = targets.linear(image.name, pixels)
    elif space in CODED:
        made = targets.of_codes(image.name, pixels)
    else:
        raise targets.TargetError(f"The image '{image.name}' is in the colour space {space}; {CODED[0]} or linear is"
                                  " needed: save it so.")
    if image.channels == 4:
        made = dataclasses.replace(made, usable=made.usable & (pixels[..., 3] > OPAQUE))
    return made


def load(path):
    """The target.Target of a picture file. Raises TargetError."""
    native = native_module.get()
    if not path.is_file():
        raise targets.TargetError(f"There is no picture '{path}'.")
    if path.suffix.lower() == ".exr":
        return targets.read(native, path)
    try:
        image = bpy.data.images.load(str(path.absolute()))
    except RuntimeError as error:
        raise targets.TargetError(f"The picture '{path}' cannot be read: {' '.join(str(error).split())}") from error
    try:
        return dataclasses.replace(target(image), name=path.name)
    finally:
        bpy.data.images.remove(image)


def mask(path, size):
    """(h, w) bool of a picture file, as target.bright. Raises TargetError."""
    return targets.bright(load(path), size)


def subject(depsgraph, material, whole, longest, samples, kind=None):
    """(subject.Subject, target.Target, factor, warnings) of what a depsgraph shows of a material.

    material: its name, or None where there is but one grain's. whole: the target.Target, which is made as small as what
    is drawn. longest: side, in pixels. kind: of cycles.kinds.KINDS, where Cycles rendered the picture with a
    material of its kind, or None where the picture shows what the material says. Raises SubjectError or native.Error.
    """
    native = native_module.get()
    _check_proportions(depsgraph.scene, whole)
    scene = export.read_scene(depsgraph, meshes.MeshCache())
    name = _choose(scene, material)
    base = dict(export.material_values(bpy.data.materials.get(name), scene.millimetres_per_unit).values)
    if kind is not None:
        base.update(kinds.our_side(kind, nodes.features()))
        scene = _widen(scene, kinds.KINDS[kind].least_sun)
    small, factor = whole.reduced(longest)
    kept = tuple(factor * side for side in small.size)
    camera = cut(native, export.camera_from_scene(depsgraph, *whole.size), whole.size, kept)
    instances = {number: _factors(drawn.material, base) for number, drawn in enumerate(scene.instances)
                 if drawn.material.name == name}
    arrays = {number: None for number, drawn in enumerate(scene.heaps) if drawn.material.name == name}
    return (Subject(native, scene.to_native(), instances, arrays, base, camera, small.size, samples, name), small,
            factor, scene.warnings)


def tracer(depsgraph, whole, small, factor, kind, samples):
    """A function of {'sigma_a', 'sigma_s', 'g'} and of one that is told how far it is: the picture of what a depsgraph
    shows, by Cycles with a material of a kind of cycles.kinds.KINDS, as large as `small`, a target.Target that was made
    of `whole` by `factor`. Raises SubjectError where Cycles cannot be asked that."""
    scene = export.read_scene(depsgraph, meshes.MeshCache(), varied=False)
    if len(scene.materials) > 1:
        raise SubjectError("Cycles corrects a match only where all is of one material; the scene shows"
                           f" {', '.join(sorted(material.name for material in scene.materials))}: hide the others, or"
                           " match without corrections.")
    if tuple(factor * side for side in small.size) != whole.size:
        raise SubjectError(f"Cycles corrects a match only where the picture's sides are multiples of {factor};"
                           f" {whole.name} is {whole.size[0]} x {whole.size[1]}: choose another size, or match without"
                           " corrections.")

    def trace(coefficients, tell):
        traced = reference.render(depsgraph, kind, small.size, samples=samples, seeds=TRACED_SEEDS,
                                  overrides={**coefficients, "scale": 1.0}, on_progress=tell)
        return traced.mean

    return trace


def grains(scene):
    """Names of the materials of an export.SceneValues that coefficients can be searched for."""
    return sorted({material.name for material in scene.materials
                   if dict(material.values)["model"] in (*TRANSLUCENT, AUTO.name)})


def _choose(scene, material):
    names = grains(scene)
    if material is None and len(names) == 1:
        return names[0]
    if not names:
        raise SubjectError("The scene shows no translucent grain: choose a model such as Model 2 for its material.")
    if material is None:
        raise SubjectError(f"The scene has several grains' materials: choose one of {', '.join(names)}.")
    if material not in names:
        raise SubjectError(f"The scene shows no translucent grain of the material '{material}'; it shows"
                           f" {', '.join(names)}.")
    return material


def _check_proportions(scene, picture):
    render = scene.render
    asked = render.resolution_x * render.pixel_aspect_x / (render.resolution_y * render.pixel_aspect_y)
    width, height = picture.size
    if abs(width / height / asked - 1.0) > PROPORTIONS:
        raise SubjectError(f"{picture.name} is {width} x {height} pixels, and the scene renders {render.resolution_x} x"
                           f" {render.resolution_y}: give the scene the picture's proportions.")


def _widen(scene, least):
    suns = (dataclasses.replace(light, angle=max(light.angle, least)) if isinstance(light, lights.SunValues) else light
            for light in scene.lights)
    return dataclasses.replace(scene, lights=tuple(suns))


def _factors(material, base):
    """By what an instance's coefficients differ from its material's, whose values are `base`; None if by nothing."""
    values = dict(material.values)
    factors = {name: tuple(channel / of if of > 0.0 else 1.0 for channel, of in zip(values[name], base[name]))
               for name in ("sigma_a", "sigma_s")}
    return factors if any(factor != (1.0,) * 3 for factor in factors.values()) else None

# From Blender's dependency graph to the native module's scene and camera: plain values, copied, nothing borrowed.
import array
import contextlib
import dataclasses
import functools
import itertools
import math
import typing

import bpy
import numpy as np

from .. import compat, native_module
from ..schema import advice, labels, models, parameters
from . import (automatic, budgets, coloured_glass, colours, heaps, instance_attributes, left_out, lens, lights,
               mesh_lights, meshes, node_colours, plain_materials, properties, scattered, surroundings, textures)

INDICES = {"air": 1.0, "water": 1.333, "oil": 1.47}
"""Of refraction, of what a grain may lie in."""


@dataclasses.dataclass(frozen=True)
class MaterialValues:
    """A material as the native module takes it: coefficients per Blender unit. `name` is for messages."""

    name: str
    values: tuple  # (parameter, value) pairs
    finish: object = None  # plain_materials.FinishValues, of what is no grain
    tint: object = None  # linear RGB that is left of light which crosses coloured glass once
    absorption: object = None  # sigma_a that does so, of the shape's own space
    is_plain: bool = False  # it is no grain

    def multiplied(self, factors):
        """The material with some of its colours multiplied. factors: {parameter: 3 numbers}."""
        if not factors:
            return self
        most = parameters.PARAMETERS["reflectance"].most
        values = dict(self.values)
        for name, factor in factors.items():
            product = (channel * each for channel, each in zip(values[name], factor))
            values[name] = tuple(min(channel, most) if name == "reflectance" else channel for channel in product)
        return dataclasses.replace(self, values=tuple(values.items()))

    def at_scale(self, scale):
        """The material of a shape that is drawn so many times as large as it is."""
        if self.absorption is None:
            return self
        values = {**dict(self.values), "sigma_a": tuple(each / scale for each in self.absorption)}
        return dataclasses.replace(self, values=tuple(values.items()), tint=None, absorption=None)

    def of_lights(self):
        """The material of an object whose faces are area lights of the scene."""
        finish = dataclasses.replace(self.finish, values=(*self.finish.values, ("faces_are_lights", True)))
        return dataclasses.replace(self, finish=finish)

    def to_native(self, native):
        """Raises native.Error naming the material if a value is out of range, or one that its model does not know."""
        values = dict(self.values)
        if automatic.asked(self):  # it is for the object to say which; any may be told whether the rest is right
            values["model"] = models.PREFERRED
        for name, known in (("profile", parameters.profiles_of), ("boundary", parameters.boundaries_of)):
            self._require(native, values["model"], name, known(values["model"]))
        try:
            if self.finish is not None:
                values["finish"] = self.finish.to_native(native)
            return native.Material(**values)
        except native.Error as error:
            raise native.Error(f"Material '{self.name}': {error}") from error

    def _require(self, native, model, parameter, known):
        """Raises native.Error unless the choice is one of those that the model knows."""
        chosen = dict(self.values).get(parameter, parameters.PARAMETERS[parameter].default)
        if chosen not in known:
            choices = " or ".join(labels.of_choice(parameter, name) for name in known)
            raise native.Error(f"Material '{self.name}': {labels.of_model(model)} takes {choices} as {parameter}; got "
                               f"'{labels.of_choice(parameter, chosen)}': choose one of these.")


@dataclasses.dataclass(frozen=True)
class InstanceValues:
    name: str
    mesh: object  # native.Mesh, equal by identity
    material: MaterialValues
    object_to_world: tuple  # 16 numbers, row-major
    broken_uvs: bool = False  # as a meshes.MeshPart's
    object: int = None  # that it is a part of, of those that wear several materials

    def typical(self):
        """Its place, 16 numbers row by row."""
        return self.object_to_world

    def to_native(self, native, material):
        transform = np.array(self.object_to_world).reshape(4, 4)
        return native.Instance(self.mesh, material, transform, self.object)


@dataclasses.dataclass(frozen=True)
class SceneValues:
    """All that a picture depends on but its camera; two are equal if they look the same."""

    instances: tuple
    lights: tuple  # lights.SunValues and lights.PlacedLightValues
    warnings: tuple
    world: surroundings.WorldValues = surroundings.WorldValues()
    heaps: tuple = ()  # heaps.HeapValues, drawn beside the instances
    millimetres_per_unit: float = 1.0
    exchange: str = parameters.SCENE["exchange"].default  # how grains send light to each other
    denoise: bool = parameters.SCENE["denoise"].default
    tolerance: float = advice.TOLERANCE  # in %, within which AUTO's models are chosen

    @property
    def materials(self):
        """MaterialValues of all that is drawn, each once."""
        return tuple(dict.fromkeys(drawn.material for drawn in (*self.instances, *self.heaps)))

    def with_materials(self, change):
        """The scene with `change` of each of its MaterialValues."""
        return dataclasses.replace(self, **{
            field: tuple(dataclasses.replace(drawn, material=change(drawn.material)) for drawn in getattr(self, field))
            for field in ("instances", "heaps")})

    def with_models_chosen(self):
        """The scene with a model in place of each AUTO: what is drawn. Raises as `to_native`."""
        if not any(automatic.asked(material) for material in self.materials):
            return self
        drawn = automatic.with_models((*self.instances, *self.heaps), self.tolerance)
        count = len(self.instances)
        return dataclasses.replace(self, instances=tuple(drawn[:count]), heaps=tuple(drawn[count:]))

    @functools.cached_property
    def models_drawn(self):
        """The names of the models of its grains, in the order of their labels; none where nothing is a grain. Raises as
        `to_native`."""
        chosen = {dict(material.values)["model"] for material in self.with_models_chosen().materials
                  if material.finish is None}
        return tuple(sorted(chosen, key=labels.of_model))

    def error_of_models(self):
        """What the models of AUTO for single things were measured to be off at most, in %; None if there are none.
        Raises as `to_native`."""
        return max((advised[1] for advised in automatic.advice_for(self.instances, self.tolerance) if advised),
                   default=None)

    def to_native(self, materials=None):
        """The native Scene. materials: {MaterialValues: native.Material} that are made already; takes in the others.
        Raises native.Error with a sentence that names the datablock at fault."""
        native = native_module.get()
        chosen = self.with_models_chosen()
        materials = {} if materials is None else materials
        for values in chosen.materials:
            if values not in materials:
                materials[values] = values.to_native(native)
        instances, arrays = ([drawn.to_native(native, materials[drawn.material]) for drawn in group]
                             for group in (chosen.instances, chosen.heaps))
        return native.Scene(
            instances=instances, arrays=arrays,
            lights=[light.to_native(native) for light in self.lights], world=self.world.to_native(native),
            exchange=self.exchange, denoise=self.denoise)


def scene_from_depsgraph(depsgraph, cache=None):
    """(native.Scene, warnings) of an evaluated dependency graph; a warning is one sentence.
    Raises native.Error if a value cannot be rendered, native_module.Unavailable without the native module."""
    values = read_scene(depsgraph, cache or meshes.MeshCache())
    return values.to_native(), values.warnings


def named(kind):
    """Blender's word for a kind of thing, such as AREA, in a sentence: with its article."""
    return f"{'an' if kind[0] in 'AEIOU' else 'a'} {kind.lower()}"


def is_sun(thing):
    """Whether an object is a light that is rendered; other lights have no angle either."""
    return thing.type == "LIGHT" and thing.data.type == "SUN"


class Region(typing.NamedTuple):
    """Part of a picture, in pixels from its lower left corner, as Blender counts them."""

    x: int
    y: int
    width: int
    height: int


def render_region(scene, width, height):
    """The Region of a width x height picture that the scene's render border asks for; all of it without one."""
    render = scene.render
    if not render.use_border:
        return Region(0, 0, width, height)
    # Blender multiplies in single precision and truncates, and expects exactly the size that follows.
    left, right = (int(np.float32(edge) * np.float32(width)) for edge in (render.border_min_x, render.border_max_x))
    lower, upper = (int(np.float32(edge) * np.float32(height)) for edge in (render.border_min_y, render.border_max_y))
    return Region(left, lower, right - left, upper - lower)


class Eye(typing.NamedTuple):
    """One eye of a stereoscopic camera, in place of the camera's own."""

    to_world: object  # mathutils.Matrix
    shift_x: float  # of the lens, as a camera has it


def require_placed(camera, matrix):
    """Raises native.Error if a camera's (4, 4) `matrix`, to the world or from there, has no inverse."""
    if not np.isfinite(matrix).all() or np.linalg.det(matrix) == 0.0:
        raise native_module.get().Error(f"Camera '{camera.name}' is scaled to nothing, or its place is no number: "
                                        "clear its scale (Object > Clear > Scale) and place it anew.")


def camera_from_scene(depsgraph, width, height, camera=None, region=None, eye=None, sharp=False):
    """native.Camera of the scene's active camera (or `camera`) for a picture of width x height pixels, or for a Region
    of it: perspective or orthographic, with sensor fit, shift, pixel aspect and depth of field as Blender has them.
    eye: an Eye of it. sharp: without depth of field.
    Raises native.Error without a camera, or for one that has no place to look from."""
    native = native_module.get()
    scene = depsgraph.scene
    camera = camera or scene.camera
    if camera is None:
        raise native.Error("The scene has no active camera: add one (Add > Camera) and make it active.")
    camera = camera.evaluated_get(depsgraph)
    render = scene.render
    to_clip = np.array(camera.calc_matrix_camera(depsgraph, x=width, y=height, scale_x=render.pixel_aspect_x,
                                                 scale_y=render.pixel_aspect_y), dtype=np.float64)
    if eye is not None:
        to_clip = _shift(eye.shift_x - camera.data.shift_x, camera.data.sensor_fit, width * render.pixel_aspect_x,
                         height * render.pixel_aspect_y) @ to_clip
    if region is not None:
        to_clip = _zoom(region, width, height) @ to_clip
    # A camera's scale does not scale its view.
    placed = (eye.to_world if eye else camera.matrix_world).normalized()
    to_world = np.array(placed, dtype=np.float64)
    require_placed(camera, to_world)
    try:
        return native.Camera(np.linalg.inv(to_world), to_clip, None if sharp else lens.of_camera(camera, placed))
    except native.Error as error:
        raise native.Error(f"Camera '{camera.name}' has a lens that shows nothing: check its focal length or "
                           "orthographic scale, its sensor and its clip distances.") from error


def _shift(shift_x, sensor_fit, width, height):
    """Clip space to clip space of a lens shifted sideways, (4, 4). width, height: of the picture, as they look. A shift
    is a part of the side that the sensor fits, by default the longer one."""
    fitted = height if sensor_fit == "VERTICAL" or (sensor_fit == "AUTO" and height > width) else width
    shifted = np.eye(4)
    shifted[0, 3] = -2.0 * shift_x * fitted / width
    return shifted


def _zoom(region, width, height):
    """Clip space of the whole picture to clip space of a region of it, (4, 4)."""
    zoom = np.eye(4)
    for axis, (start, length, whole) in enumerate(((region.x, region.width, width),
                                                   (region.y, region.height, height))):
        zoom[axis, axis] = whole / length
        zoom[axis, 3] = (whole - 2.0 * start - length) / length
    return zoom


def per_unit(parameter, value, millimetres_per_unit):
    """A parameter's value as the native module takes it: coefficients in 1/mm become those per Blender unit."""
    if parameter in ("sigma_a", "sigma_s"):
        return tuple(channel * millimetres_per_unit for channel in value)
    return value


def overrides(settings, scene):
    """{parameter: value} with coefficients in 1/mm, as a command line gives them, as {parameter: value} per Blender
    unit of a bpy.types.Scene."""
    unit = scene.mesograin.millimetres_per_unit
    return {parameter: per_unit(parameter, value, unit) for parameter, value in settings.items()}


def material_values(material, millimetres_per_unit, reading=None):
    """MaterialValues of a Blender material, or of what Cycles shows where a slot is empty (None). reading:
    plain_materials.Reading of what is no grain, if that was read already."""
    if material is None:
        values, finish = plain_materials.of_no_material()
        return MaterialValues("(none)", tuple({**dict(_default_parameters(millimetres_per_unit)), **values}.items()),
                              finish, is_plain=True)
    values = dict(_parameters(material.mesograin, millimetres_per_unit))
    # By hand, a choice of what the grain lies in changes eta at once; of an animated one Blender tells nobody.
    said, eta = material.mesograin_look, parameters.PARAMETERS["eta"]
    values["eta"] = min(max(values["eta"] * said.index_around / INDICES[said.surroundings], eta.least), eta.most)
    if not plain_materials.is_plain(material):
        return MaterialValues(material.name_full, tuple(values.items()))
    reading = reading or plain_materials.read(material)
    return MaterialValues(material.name_full, tuple({**values, **reading.values}.items()), reading.finish, reading.tint,
                          is_plain=True)


def read_scene(depsgraph, cache, varied=True, unwrapped=None):
    """SceneValues of an evaluated dependency graph; `cache` spares reading meshes twice. varied: whether instances have
    colours of their own, which a comparison's other side does not know. unwrapped: the name of an object of which no
    grain stands for its copies, as each has UVs of its own."""
    reader = _Reader(depsgraph, cache, varied, unwrapped=unwrapped)
    reader.read_all(depsgraph)
    return reader.scene_values(depsgraph.scene)


def read_scene_in_motion(depsgraph, cache):
    """(SceneValues, function). The function reads SceneValues of the same dependency graph at another time, of which
    the places alone count: materials are those of before."""
    first = _Reader(depsgraph, cache, True)
    first.read_all(depsgraph)

    def read_again():
        cache.forget()  # addresses of shapes that were evaluated anew
        reader = _Reader(depsgraph, cache, True, first)
        reader.read_all(depsgraph)
        return reader.places()

    return first.scene_values(depsgraph.scene), read_again


def with_new_materials(values, depsgraph):
    """`values`, read before, with the materials that have changed since, or None if anything else may have: then all is
    to be read again. A slider of a material does not read a hundred thousand placings."""
    changed = {}
    scene = depsgraph.scene
    for update in depsgraph.updates:
        material = update.id
        if isinstance(material, bpy.types.Scene) or _goes_with_a_material(update):
            continue  # Blender tags scenes for mouse and keys, too; what counts of them is looked at below
        if not isinstance(material, bpy.types.Material) or plain_materials.is_plain(material):
            return None
        told = f"Material '{material.name}'"
        if material.mesograin_colours.vary or any(told in warning for warning in values.warnings):
            return None
        changed[material.name_full] = material_values(material, scene.mesograin.millimetres_per_unit)
    as_before = (values.millimetres_per_unit == scene.mesograin.millimetres_per_unit
                 and values.exchange == scene.mesograin.exchange
                 and values.denoise == scene.mesograin.denoise
                 and values.tolerance == budgets.tolerance(scene.mesograin)
                 and values.world == surroundings.read(scene, _world_side(depsgraph), depsgraph.view_layer)[0])
    if not changed or not as_before or any(heap.factors and heap.material.name in changed for heap in values.heaps):
        return None
    if any(material.is_plain and material.name in changed for material in values.materials):
        return None  # what becomes a grain is read as its bodies
    return values.with_materials(lambda material: changed.get(material.name, material))


def _world_side(depsgraph):
    return surroundings.COARSE if depsgraph.mode == "VIEWPORT" else surroundings.SIDE


def _goes_with_a_material(update):
    """Whether a depsgraph's update says no more than that a material has changed: from Blender 5 on its nodes and what
    wears it are tagged with it."""
    if isinstance(update.id, (bpy.types.Object, bpy.types.Mesh, bpy.types.Curve, bpy.types.MetaBall)):
        return not (update.is_updated_geometry or update.is_updated_transform)
    return isinstance(update.id, bpy.types.ShaderNodeTree)


def _parameters(grain, millimetres_per_unit):
    for parameter in properties.MATERIAL_PARAMETERS:
        value = per_unit(parameter, getattr(grain, parameter), millimetres_per_unit)
        if not isinstance(value, (str, float, bool)):
            value = tuple(value)
        yield parameter, value


def _default_parameters(millimetres_per_unit):
    declared = properties.MaterialProperties.bl_rna.properties
    default = {name: tuple(declared[name].default_array) if getattr(declared[name], "is_array", False)
               else declared[name].default for name in properties.MATERIAL_PARAMETERS}
    return _parameters(typing.NamedTuple("Grain", [(name, object) for name in default])(**default),
                       millimetres_per_unit)


def _in_slot(evaluated_object, slot):
    """The bpy.types.Material of a face, or None."""
    slots = evaluated_object.material_slots
    # Faces may name a slot that is gone; Blender then shows the last one.
    return slots[min(slot, len(slots) - 1)].material if slots else None


class _Reader:
    """Collects what one pass over the instances finds; complaints come once, however often an object is instanced."""

    def __init__(self, depsgraph, cache, varied, before=None, unwrapped=None):
        self._millimetres_per_unit = depsgraph.scene.mesograin.millimetres_per_unit
        # An artist who drags waits for what is painted.
        self._side = textures.COARSE if depsgraph.mode == "VIEWPORT" else textures.SIDE
        self._world_side = _world_side(depsgraph)
        self._layer = depsgraph.view_layer
        self._override = depsgraph.view_layer_eval.material_override if varied else None
        self._cache = cache
        self._varied = varied
        self._unwrapped = unwrapped
        self._materials = before._materials if before else {}
        # {key of a material: the input that says the reflectance of each instance}
        self._by_instance = before._by_instance if before else {}
        self._instances = []
        self._objects = itertools.count()  # numbers of those that have several parts
        self._groups = []  # heaps.Group of each shape that is read with all its placings at once
        self._lights = []
        self._warnings = {}

    def read_all(self, depsgraph):
        shown = scattered.read(depsgraph)
        if shown is None or not self._read_shown(shown):
            self._read_each(depsgraph)

    def _read_shown(self, shown):
        """Reads the scattered.Shown of all objects. False, and nothing is read, if instances need to be looked at."""
        found, groups = {}, []  # {shape: arrays of its placings}; heaps.Groups with their placings
        for each in shown:
            for shape, placings in each.placings_of().items():
                found.setdefault(shape, []).append(placings)
        for shape, placings in found.items():
            group = self._group(shape)
            if group is None or group.varies:
                return False
            group.place(np.concatenate(placings))
            groups.append(group)
        for each in shown:
            self._read(each.thing, each.thing.matrix_world)
        self._groups += groups
        return True

    def _read_each(self, depsgraph):
        """Of instancers' placings there may be a million: of each is asked only which shape it is, and Blender fills an
        array with their matrices."""
        numbers, groups = {}, []  # {(instanced object, its data): its number}; heaps.Group or None of each
        worn, readers = [], []  # instance_attributes.Worn of each; objects that tell of instances
        of_instance = array.array("i")
        for instance in depsgraph.object_instances:
            instanced = instance.instance_object
            number = heaps.ITSELF if instanced is None else heaps.HIDDEN
            if instance.show_self:
                shape = instance.object
                if instanced is None:
                    if instance_attributes.instancer_of(shape) is not None:
                        readers.append(shape)
                    self._read(shape, instance.matrix_world)
                else:
                    # `shape` may be a passing object, in which several that differ in their data follow each other.
                    key = (instanced, shape.data)
                    number = numbers.get(key, -1)
                    if number < 0:
                        number = numbers[key] = len(groups)
                        group = self._group(shape)
                        groups.append(group)
                        worn.append(instance_attributes.Worn(shape, group.attributes if group else ()))
                    if groups[number] is None:
                        self._read(shape, instance.matrix_world)
            of_instance.append(number)
        self._groups += [group for group in groups if group is not None]
        if any(groups):
            numbers = np.frombuffer(of_instance, dtype=np.int32)
            for sentence in heaps.place(depsgraph, numbers, groups, worn, readers):
                self._warn(sentence)

    def _group(self, shape):
        """heaps.Group of a shape that can be drawn, else None."""
        if not meshes.is_shape(shape):
            return None
        parts = self._cache.parts(shape, self._override)
        if not any(part.has_area for part in parts) or any(part.broken_uvs for part in parts):
            return None
        parts = [part for part in parts if self._has_surface(shape, part.slot)]
        if not parts:
            return None
        for sentence in left_out.sentences(shape):
            self._warn(sentence)
        materials = [self._coloured(self._material(shape, part.slot, many=True), shape, part.mesh) for part in parts]
        for part, material in zip(parts, materials):
            self._warn_of_cut(part, material, shape.name)
        if any(material.finish and material.finish.radiance for material in materials):
            self._warn(f"Instances of '{shape.name}' shine, but on nothing: only objects of their own are lights to "
                       "others.")
        return heaps.Group(shape.name, [each for part, material in zip(parts, materials)
                                        for each in self._parts_of(shape, part, material)])

    def _parts_of(self, shape, part, material):
        """[heaps.Part] of an instanced shape's meshes.MeshPart: one, or one of each of its bodies."""
        variation = self._variation(shape, part.slot)
        bodies = () if shape.name == self._unwrapped else self._bodies(shape, part)
        return [heaps.Part(mesh, material, variation, placings)
                for mesh, placings in bodies] or [heaps.Part(part.mesh, material, variation)]

    def _bodies(self, shape, part):
        """MeshPart.bodies of grains; () of what is none, as a jar of two sheets."""
        material = self._worn(shape, part.slot)
        if material is None or plain_materials.is_plain(material):
            return ()
        return part.bodies(copies=shape.name != self._unwrapped)

    def _read(self, shape, matrix_world):
        if meshes.is_shape(shape):
            self._read_drawable(shape, matrix_world)
        elif shape.type == "LIGHT":
            self._read_light(shape, matrix_world)
        elif shape.type == "POINTCLOUD":
            self._read_points(shape, matrix_world)
        elif shape.type in ("CURVES", "VOLUME"):
            self._warn(f"Object '{shape.name}' is {named(shape.type)} object, which Mesograin does not draw: "
                       "convert it to a mesh.")

    def _read_points(self, cloud, matrix_world):
        if len(cloud.data.points) == 0:
            self._warn(f"Object '{cloud.name}' has no points, so nothing of it is drawn.")
            return
        group = heaps.Group(cloud.name, [heaps.Part(heaps.sphere(), self._material(cloud, 0))])
        group.place(heaps.point_placings(cloud.data, matrix_world))
        self._groups.append(group)

    def _gather(self):
        """Few placings become instances, which can be chosen one by one; many become heaps."""
        found = []
        for group in self._groups:
            parts, bodies, lost = group.values()
            if lost:
                self._warn(f"{lost} instances of '{group.name}' are scaled to nothing or have a place that is no "
                           "number, so they are not drawn.")
            # Those of several parts stand at the same placings.
            objects = [next(self._objects) for _ in parts[0].each()] if len(parts) > 1 and len(
                parts[0]) < heaps.MANY else itertools.repeat(None)
            for heap, wholes in (*((part, objects) for part in parts),
                                 *((body, itertools.repeat(None)) for body in bodies)):
                if len(heap) >= heaps.MANY:
                    found.append(heap)
                    continue
                self._instances.extend(InstanceValues(heap.name, heap.mesh, material, placing, object=whole)
                                       for placing, material, whole in zip(heap.each(), heap.materials(), wholes))
        return tuple(found)

    def places(self):
        """SceneValues of what stands where, and nothing else."""
        gathered = self._gather()
        return SceneValues(tuple(self._instances), (), (), heaps=gathered)

    def scene_values(self, scene):
        gathered = self._gather()
        self._warn_of_many_shapes((*self._instances, *gathered), budgets.tolerance(scene.mesograin))
        if not self._instances and not gathered:
            self._warn("There is nothing to draw: add a mesh that is visible in renders.")
        around, sentences = surroundings.read(scene, self._world_side, self._layer)
        for sentence in sentences:
            self._warn(sentence)
        if not self._lights and not around.shines:
            self._warn("With no light and a black world the picture is black: add a light (Add > Light).")
        for sentence in (*left_out.of_scene(scene), *left_out.of_layer(self._layer)):
            self._warn(sentence)
        camera = scene.camera
        if camera is not None and camera.type == "CAMERA" and camera.data.type == "PANO":
            self._warn(f"Camera '{camera.name}' is panoramic, which Mesograin draws as perspective.")
        return SceneValues(tuple(self._instances), (*self._lights, *around.suns), tuple(self._warnings), around,
                           gathered, self._millimetres_per_unit, scene.mesograin.exchange, scene.mesograin.denoise,
                           budgets.tolerance(scene.mesograin))

    def _warn_of_many_shapes(self, things, tolerance):
        # Errors are said where the models are chosen.
        with contextlib.suppress(native_module.get().Error):
            for name, shapes in automatic.of_many_shapes(things, tolerance).items():
                label = models.CHOICES[automatic.OF_MANY[0]].label
                self._warn(f"Material '{name}' is worn by {shapes} grains of different shape, and following light in "
                           f"each takes long: Auto draws them by {label}. Choose Transport to wait for it.")

    def _read_drawable(self, evaluated_object, matrix_world):
        parts = self._cache.parts(evaluated_object, self._override)
        if not parts:
            if evaluated_object.type == "META":
                return  # a family of metaballs is drawn with its first member
            if evaluated_object.is_instancer:
                return  # its vertices may show others
            if any(modifier.type == "NODES" for modifier in evaluated_object.modifiers):
                return  # which may have made instances of it and nothing else
            self._warn(f"Object '{evaluated_object.name}' has no faces, so nothing of it is drawn.")
            return
        if not any(part.has_area for part in parts):
            self._warn(f"Object '{evaluated_object.name}' has faces without any area, so nothing of it is drawn: "
                       "spread its vertices.")
            return
        to_world = matrix_world[0][:] + matrix_world[1][:] + matrix_world[2][:] + matrix_world[3][:]
        if not math.isfinite(sum(to_world)):
            self._warn(f"Object '{evaluated_object.name}' has a place, rotation or scale that is no number, so it is "
                       "not drawn.")
            return
        if not meshes.has_extent(matrix_world):
            self._warn(f"Object '{evaluated_object.name}' is scaled to nothing, so it is not drawn.")
            return
        for sentence in left_out.sentences(evaluated_object):
            self._warn(sentence)
        whole = next(self._objects) if len(parts) > 1 else None
        for part in parts:
            if not self._has_surface(evaluated_object, part.slot):
                continue
            material = self._coloured(self._material(evaluated_object, part.slot), evaluated_object, part.mesh)
            bodies = self._bodies(evaluated_object, part)
            if bodies:
                variation = self._variation(evaluated_object, part.slot)
                self._read_bodies(evaluated_object.name, bodies, material, variation, to_world, part.broken_uvs)
                continue
            material = material.at_scale(meshes.scale(matrix_world))
            self._warn_of_cut(part, material, evaluated_object.name)
            if self._read_mesh_lights(evaluated_object, matrix_world, part.slot, material):
                material = material.of_lights()
            self._instances.append(InstanceValues(evaluated_object.name, part.mesh, material, to_world,
                                                  part.broken_uvs, whole))

    def _read_bodies(self, name, bodies, material, variation, to_world, broken_uvs):
        if name == self._unwrapped:
            self._instances.extend(InstanceValues(name, mesh, material, to_world, broken_uvs) for mesh, _ in bodies)
            return
        if variation is not None and not variation.of_bodies:
            variation = None
        group = heaps.Group(name, [heaps.Part(mesh, material, variation, placings) for mesh, placings in bodies])
        group.place(np.array(to_world).reshape(1, 4, 4),
                    {"random": np.array((node_colours.random_of(name),), dtype=np.float32)})
        self._groups.append(group)

    def _read_mesh_lights(self, evaluated_object, matrix_world, slot, material):
        """Whether there are any."""
        radiance = material.finish and material.finish.radiance
        if not radiance:
            return False
        worn = meshes.slots_worn(evaluated_object, self._override)
        found = mesh_lights.read(evaluated_object, matrix_world, slot, worn, radiance)
        if found is None:
            self._warn(f"Object '{evaluated_object.name}' shines, but on nothing: only up to {mesh_lights.MOST_FACES} "
                       "rectangular faces are lights to others.")
            return False
        self._lights.extend(found)
        return True

    def _worn(self, evaluated_object, slot):
        """The bpy.types.Material of faces, or None."""
        return self._override or _in_slot(evaluated_object, slot)

    def _variation(self, evaluated_object, slot):
        material = self._worn(evaluated_object, slot)
        if material is None:
            return None
        key = self._key(evaluated_object, slot, material, many=True)
        if key in self._by_instance:
            return colours.NodeVariation("reflectance", self._by_instance[key],
                                         self._own(evaluated_object, node_colours.attributes(self._by_instance[key])))
        model = dict(self._material(evaluated_object, slot, many=True).values)["model"]
        attributes = node_colours.attributes_of(material.node_tree.nodes) if compat.uses_nodes(material) else ()
        variation = colours.read(material, models.CHOICES[model].parameters, self._own(evaluated_object, attributes))
        if variation is not None and not self._varied:
            self._warn(f"The grains of material '{material.name}' vary in colour, unknown to the reference: "
                       "they are compared in the material's own.")
            return None
        return variation

    @staticmethod
    def _own(evaluated_object, attributes):
        """node_colours.of_object's of what is instanced. attributes: (kind, name) pairs; instancers' are each one's."""
        own = [each for each in attributes if each[0] == "OBJECT"]
        found = instance_attributes.of_object(evaluated_object, own)
        return node_colours.of_object(0.5, tuple(evaluated_object.color), tuple(found.items()))

    def _key(self, evaluated_object, slot, material, many):
        """What tells how a material looks on an object: its name, then the object's Box and mesh and its colour and
        name, each if it matters. many: it is instanced, and colours are each instance's own."""
        worn = own = None
        if material is not None and plain_materials.is_plain(material):
            if plain_materials.depends_on_place(material):
                worn = textures.Box.of(evaluated_object), self._mesh_with(evaluated_object, slot)
            if self._varied and plain_materials.depends_on_object(material):
                found = instance_attributes.of_object(evaluated_object, plain_materials.attributes(material))
                own = (many, evaluated_object.name, tuple(evaluated_object.color), tuple(sorted(found.items())))
        return material and material.name_full, worn, own

    def _mesh_with(self, evaluated_object, slot):
        """The native.Mesh of a slot of a shape."""
        if not meshes.is_shape(evaluated_object):
            return None
        parts = self._cache.parts(evaluated_object, self._override)
        return next((part.mesh for part in parts if part.slot == slot), None)

    def _warn_of_cut(self, part, material, name):
        if part.is_cut and models.CHOICES[dict(material.values)["model"]].translucent:
            self._warn(f"Object '{name}' wears several materials on one body, so light does not go from one's part of "
                       "it to the other's and its brightness is wrong: give all its faces the same grain.")

    def _has_surface(self, evaluated_object, slot):
        """Whether faces are more than the border of a volume, or of nothing: a surface in their place would hide what
        is behind. In a comparison both sides draw one."""
        material = self._worn(evaluated_object, slot)
        if not self._varied or material is None or not plain_materials.is_plain(material):
            return True
        what = plain_materials.without_surface(material)
        if what is not None:
            self._warn(f"Material '{material.name}' is {what}, so what wears it is left out: if it is a grain, choose "
                       "a model for it.")
        return what is None

    def _material(self, evaluated_object, slot, many=False):
        material = self._worn(evaluated_object, slot)
        reading = None
        key = self._key(evaluated_object, slot, material, many)
        if key not in self._materials:
            if material is not None and plain_materials.is_plain(material):
                _, worn, own = key
                box, mesh = worn or (textures.Box(), None)
                coordinates = plain_materials.AVERAGE
                if own is not None:
                    coordinates = None if many else node_colours.of_object(node_colours.random_of(own[1]), *own[2:])
                reading = plain_materials.read(material, box, coordinates, self._side, mesh)
                if reading.by_instance is not None:
                    self._by_instance[key] = reading.by_instance
                for sentence in reading.sentences:
                    self._warn(sentence)
                if reading.finish is not None and not self._varied:
                    self._warn(f"Material '{material.name}' is compared in its mean colour, without coat, pictures or "
                               "light of its own.")
            values = material_values(material, self._millimetres_per_unit, reading)
            self._materials[key] = values if self._varied else dataclasses.replace(values, finish=None)
        return self._materials[key]

    def _coloured(self, material, evaluated_object, mesh):
        """A material with what its glass absorbs on an object, if it is of glass and coloured."""
        if material.tint is None:
            return material
        absorption = coloured_glass.absorption(evaluated_object, mesh, material.tint, dict(material.values)["eta"])
        if absorption is None:
            self._warn(f"Object '{evaluated_object.name}' is not closed, so its glass is drawn without its colour.")
        return dataclasses.replace(material, tint=None, absorption=absorption)

    def _read_light(self, evaluated_object, matrix_world):
        if not math.isfinite(sum(sum(row) for row in matrix_world)):
            self._warn(f"Light '{evaluated_object.name}' has a place, rotation or scale that is no number, so it is "
                       "left out.")
            return
        values, sentences = lights.read(evaluated_object, matrix_world)
        for sentence in (*sentences, *left_out.of_light(evaluated_object)):
            self._warn(sentence)
        if values is not None:
            self._lights.append(values)

    def _warn(self, sentence):
        self._warnings.setdefault(sentence)

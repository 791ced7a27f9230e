# From Blender's dependency graph to the native module's scene and camera: plain values, copied, nothing borrowed.
import dataclasses
import math
import typing

import numpy as np

from . import meshes, native_module, properties


@dataclasses.dataclass(frozen=True)
class MaterialValues:
    """A material as the native module takes it: coefficients per Blender unit. `name` is for messages."""

    name: str
    values: tuple  # (parameter, value) pairs

    def to_native(self, native):
        """Raises native.Error naming the material if a value is out of range."""
        try:
            return native.Material(**dict(self.values))
        except native.Error as error:
            raise native.Error(f"Material '{self.name}': {error}") from error


@dataclasses.dataclass(frozen=True)
class InstanceValues:
    name: str
    mesh: object  # native.Mesh, equal by identity
    material: MaterialValues
    object_to_world: tuple  # 16 numbers, row-major
    broken_uvs: bool = False  # as a meshes.MeshPart's

    def to_native(self, native, material):
        transform = np.array(self.object_to_world).reshape(4, 4)
        return native.Instance(self.mesh, material, transform)


@dataclasses.dataclass(frozen=True)
class LightValues:
    name: str
    direction_to_light: tuple
    irradiance: tuple
    angle: float

    def to_native(self, native):
        try:
            return native.DirectionalLight(direction_to_light=self.direction_to_light, irradiance=self.irradiance,
                                           angle=self.angle)
        except native.Error as error:
            raise native.Error(f"Light '{self.name}': {error}") from error


@dataclasses.dataclass(frozen=True)
class SceneValues:
    """All that a picture depends on but its camera; two are equal if they look the same."""

    instances: tuple
    lights: tuple
    warnings: tuple

    def to_native(self):
        """The native Scene. Raises native.Error with a sentence that names the datablock at fault."""
        native = native_module.get()
        materials = {values: values.to_native(native) for values in
                     dict.fromkeys(instance.material for instance in self.instances)}
        return native.Scene(
            instances=[instance.to_native(native, materials[instance.material]) for instance in self.instances],
            lights=[light.to_native(native) for light in self.lights])


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


def camera_from_scene(depsgraph, width, height, camera=None, region=None, eye=None):
    """native.Camera of the scene's active camera (or `camera`) for a picture of width x height pixels, or for a Region
    of it: perspective or orthographic, with sensor fit, shift and pixel aspect as Blender has them; eye: an Eye of it.
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
    to_world = np.array((eye.to_world if eye else camera.matrix_world).normalized(), dtype=np.float64)
    if not np.isfinite(to_world).all() or np.linalg.det(to_world) == 0.0:
        raise native.Error(f"Camera '{camera.name}' is scaled to nothing, or its place is no number: clear its scale "
                           "(Object > Clear > Scale) and place it anew.")
    try:
        return native.Camera(np.linalg.inv(to_world), to_clip)
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


def material_values(material, millimetres_per_unit):
    """MaterialValues of a Blender material, or of the default grain where a slot is empty (None)."""
    if material is None:
        return MaterialValues("(none)", tuple(_default_parameters(millimetres_per_unit)))
    return MaterialValues(material.name_full, tuple(_parameters(material.mesograin, millimetres_per_unit)))


def read_scene(depsgraph, cache):
    """SceneValues of an evaluated dependency graph; `cache` spares reading meshes twice."""
    reader = _Reader(depsgraph.scene.mesograin.millimetres_per_unit, cache)
    for instance in depsgraph.object_instances:
        if instance.show_self:
            reader.read(instance)
    return reader.scene_values(depsgraph.scene)


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


def _shines(world):
    """Whether a world lights the scene in Cycles, as far as its nodes tell without evaluating them."""
    if world is None:
        return False
    if not world.use_nodes:
        return any(world.color)
    output = world.node_tree.get_output_node("CYCLES")
    links = output.inputs["Surface"].links if output else ()
    if not links:
        return False
    node = links[0].from_node
    if node.type != "BACKGROUND":
        return True
    colour, strength = node.inputs["Color"], node.inputs["Strength"]
    dark = not colour.is_linked and not any(colour.default_value[:3])
    off = not strength.is_linked and strength.default_value == 0.0
    return not (dark or off)


class _Reader:
    """Collects what one pass over the instances finds; complaints come once, however often an object is instanced."""

    def __init__(self, millimetres_per_unit, cache):
        self._millimetres_per_unit = millimetres_per_unit
        self._cache = cache
        self._materials = {}
        self._instances = []
        self._lights = []
        self._warnings = {}

    def read(self, instance):
        kind = instance.object.type
        if meshes.is_shape(instance.object):
            self._read_drawable(instance.object, instance.matrix_world)
        elif kind == "LIGHT":
            self._read_light(instance.object, instance.matrix_world)
        elif kind in ("CURVES", "POINTCLOUD", "VOLUME"):
            self._warn(f"Object '{instance.object.name}' is {named(kind)} object, which Mesograin does not draw: "
                       "convert it to a mesh.")

    def scene_values(self, scene):
        if not self._instances:
            self._warn("There is nothing to draw: add a mesh that is visible in renders.")
        if not self._lights:
            self._warn("The scene has no sun light, so everything is black: add one (Add > Light > Sun).")
        if _shines(scene.world):
            self._warn(f"World '{scene.world.name}' shines, but only suns are rendered: light the scene with suns, and "
                       "make the world black to see what is left without it.")
        camera = scene.camera
        if camera is not None and camera.type == "CAMERA" and camera.data.type == "PANO":
            self._warn(f"Camera '{camera.name}' is panoramic, which Mesograin draws as perspective.")
        return SceneValues(tuple(self._instances), tuple(self._lights), tuple(self._warnings))

    def _read_drawable(self, evaluated_object, matrix_world):
        parts = self._cache.parts(evaluated_object)
        if not parts:
            if evaluated_object.type == "META":
                return  # a family of metaballs is drawn with its first member
            self._warn(f"Object '{evaluated_object.name}' has no faces, so nothing of it is drawn.")
            return
        if not any(part.has_area for part in parts):
            self._warn(f"Object '{evaluated_object.name}' has faces without any area, so nothing of it is drawn: "
                       "spread its vertices.")
            return
        # Heaps have instances by the ten thousands, and slices are the fastest way out of a Blender matrix.
        to_world = matrix_world[0][:] + matrix_world[1][:] + matrix_world[2][:] + matrix_world[3][:]
        if not math.isfinite(sum(to_world)):
            self._warn(f"Object '{evaluated_object.name}' has a place, rotation or scale that is no number, so it is "
                       "not drawn.")
            return
        if not meshes.has_extent(matrix_world):
            self._warn(f"Object '{evaluated_object.name}' is scaled to nothing, so it is not drawn.")
            return
        for part in parts:
            self._instances.append(InstanceValues(evaluated_object.name, part.mesh,
                                                  self._material(evaluated_object, part.slot), to_world,
                                                  part.broken_uvs))

    def _material(self, evaluated_object, slot):
        slots = evaluated_object.material_slots
        # Faces may name a slot that is gone; Blender then shows the last one.
        material = slots[min(slot, len(slots) - 1)].material if slots else None
        key = material and material.name_full
        if key not in self._materials:
            self._materials[key] = material_values(material, self._millimetres_per_unit)
        return self._materials[key]

    def _read_light(self, evaluated_object, matrix_world):
        light = evaluated_object.data
        if not is_sun(evaluated_object):
            self._warn(f"Light '{evaluated_object.name}' is {named(light.type)} light; only suns are rendered.")
            return
        if light.use_nodes:
            self._warn(f"Light '{evaluated_object.name}' has nodes, which are left out: its own colour and strength "
                       "are rendered.")
        # A sun shines along its -z axis, and its strength is irradiance already.
        direction = matrix_world.to_3x3().col[2].normalized()
        self._lights.append(LightValues(evaluated_object.name, tuple(direction),
                                        tuple(channel * light.energy for channel in light.color),
                                        min(light.angle, math.pi)))

    def _warn(self, sentence):
        self._warnings.setdefault(sentence)

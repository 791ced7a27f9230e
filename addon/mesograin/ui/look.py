# A grain as an artist says it: material.mesograin_look, kept in step with material.mesograin by being computed from it.
import typing

import bpy
import numpy as np
from bpy.props import EnumProperty, FloatProperty, FloatVectorProperty, PointerProperty

from .. import native_module
from ..schema import advice, models
from ..scene import budgets, export, meshes, thick_layer
from ..scene.properties import OVERRIDABLE
from .active_material import OnActiveMaterial, active_material

UNKNOWN = (0.0, 0.0, 0.0)


def _colour(look):
    grain = look.id_data.mesograin
    albedos = thick_layer.reduced(grain.sigma_a, grain.sigma_s, grain.g)[1]
    try:
        return thick_layer.colour(tuple(albedos), grain.eta, grain.boundary)
    except _sentences():
        return UNKNOWN


def _set_colour(look, colour):
    _set(look, colour, _paths(look))


def _paths(look):
    grain = look.id_data.mesograin
    return thick_layer.mean_free_paths(grain.sigma_a, grain.sigma_s, grain.g, grain.scale)


def _set_paths(look, paths):
    # The albedos stay as they are to the last digit: it is the coefficients that are scaled.
    grain = look.id_data.mesograin
    extinctions = thick_layer.reduced(grain.sigma_a, grain.sigma_s, grain.g)[0]
    scale = _scale(grain)
    factors = [1.0 / (path * scale * t) if t > 0.0 else 0.0 for path, t in zip(paths, extinctions)]
    empty = [1.0 / (path * scale * thick_layer.rest(grain.g)) if t <= 0.0 else 0.0
             for path, t in zip(paths, extinctions)]
    grain.sigma_a = [factor * a for factor, a in zip(factors, grain.sigma_a)]
    grain.sigma_s = [factor * s + more for factor, s, more in zip(factors, grain.sigma_s, empty)]


def _set(look, colour, paths):
    grain = look.id_data.mesograin
    scale = _scale(grain)
    try:
        sigma_a, sigma_s = thick_layer.coefficients(colour, [path * scale for path in paths], grain.g, grain.eta,
                                                    grain.boundary)
    except _sentences():
        return
    grain.sigma_a, grain.sigma_s = sigma_a, sigma_s


def _scale(grain):
    if grain.scale <= 0.0:
        grain.scale = 1.0
    return grain.scale


def _sentences():
    """What may go wrong by a user's doing, or for want of the native module."""
    try:
        return (native_module.Unavailable, native_module.get().Error)
    except native_module.Unavailable:
        return (native_module.Unavailable,)


def _surround(look, _context):
    index = export.INDICES[look.surroundings]
    look.id_data.mesograin.eta *= look.index_around / index
    look.index_around = index


class LookProperties(bpy.types.PropertyGroup):
    """`material.mesograin_look`. Of colour and mean free path it holds nothing: they are the coefficients."""

    way: EnumProperty(
        name="Set by", default="coefficients", override=OVERRIDABLE,
        description="In which words the medium is said: both are kept in step", items=(
            ("coefficients", "Sigma", "Say the medium as physics does: sigma_s, sigma_a and a scale", 0),
            ("look", "Look", "Say the medium by the colour of a thick layer and how far light goes in it", 1)))
    colour: FloatVectorProperty(
        name="Colour", subtype="COLOR", size=3, min=0.0, max=1.0, get=_colour, set=_set_colour, override=OVERRIDABLE,
        description="What an endless layer sends back of the light that enters it from everywhere: lighter is less"
        " absorption. Free paths stay. With g it is that of the reduced medium")
    mean_free_path: FloatVectorProperty(
        name="Free Path", size=3, min=thick_layer.SHORTEST, max=thick_layer.LONGEST, precision=3, get=_paths,
        set=_set_paths, override=OVERRIDABLE, description="How far light of each channel goes, in mm, before it has"
        " lost its direction or is absorbed: longer looks clearer. The colour stays")
    surroundings: EnumProperty(
        name="Lies in", default="air", update=_surround, override=OVERRIDABLE, description="What is around the grain."
        " eta is relative to it: a wet grain refracts and reflects less, and more of what is inside shows", items=tuple(
            (name, name.capitalize(), f"Index of refraction {index:g}", number)
            for number, (name, index) in enumerate(export.INDICES.items())))
    index_around: FloatProperty(default=1.0, options={"HIDDEN"}, override=OVERRIDABLE)

    def forget_surroundings(self):
        """The grain lies in air from here on, and its eta is what it is."""
        self.index_around = export.INDICES["air"]
        self.surroundings = "air"


def _is_on(material, thing):
    """Whether an object's own faces are of a material: those of a pile, and of what grains are scattered on, are not of
    theirs."""
    if thing.type != "MESH":
        return True
    slots = thing.material_slots
    if len(slots) < 2:
        return len(thing.data.polygons) > 0
    return any(slots[number].material == material for number in meshes.used_slots(thing.data, len(slots)))


def grain_size(material, thing, millimetres_per_unit):
    """mm of a grain of this material that a bpy.types.Object is or has many of, in its longest direction; 0 of what is
    none."""
    return max(_sizes(thing)) * millimetres_per_unit if _is_on(material, thing) else 0.0


def hint(material, thing, millimetres_per_unit):
    """A sentence on how thick a bpy.types.Object of this material is for light, or one of the grains that it has; empty
    where there is nothing to say."""
    if not _is_on(material, thing):
        return ""
    paths = _paths(material.mesograin_look)
    sizes = [size * millimetres_per_unit for size in _sizes(thing)]
    thick = thick_layer.thickness(sizes, paths)
    if not thick > 0.0 or sorted(paths)[1] >= thick_layer.LONGEST:
        return ""
    return f"{thick:.2g} mean free paths thick: {thick_layer.looks(thick)}."


class Seen(typing.NamedTuple):
    """A mesh object before its modifiers, or a grain of the middle size of those that it has, in the scene's units."""

    shape: tuple  # volume, area, whether it is closed
    sizes: tuple  # along the object's axes
    is_one_of_many: bool


def _look_at(thing):
    """Seen; None of what encloses nothing."""
    if thing is None or thing.type != "MESH" or not thing.data.polygons:
        return None
    mesh = thing.data
    mesh.calc_loop_triangles()
    corners = np.empty((len(mesh.loop_triangles), 3), dtype=np.int32)
    mesh.loop_triangles.foreach_get("vertices", corners.ravel())
    places = np.empty((len(mesh.vertices), 3), dtype=np.float32)
    mesh.vertices.foreach_get("co", places.ravel())
    places, corners, is_many = _middle_body(places, corners)
    linear = np.array(thing.matrix_world.to_3x3(), dtype=np.float64)
    a, b, c = (places.astype(np.float64) @ linear.T)[corners].transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    volume = abs(np.einsum("ij,ij->", a, normals)) / 6.0
    area = 0.5 * np.linalg.norm(normals, axis=1).sum()
    edges = np.sort(corners[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    closed = bool((np.unique(edges, axis=0, return_counts=True)[1] == 2).all())
    if not (volume > 0.0 and area > 0.0):
        return None
    sizes = np.ptp(places, axis=0) * np.linalg.norm(linear, axis=0)
    copied = any(modifier.type == "ARRAY" for modifier in thing.modifiers)
    return Seen((volume, area, closed), tuple(map(float, sizes)), is_many or copied)


def _middle_body(places, corners):
    """(places, corners) of that body of a mesh which is of the middle size, and whether it has more."""
    try:
        native = native_module.get()
        bodies = native.Mesh(places, None, corners.astype(np.uint32)).bodies(np.arange(len(places)))
    except _sentences():
        bodies = ()
    if not bodies:
        return places, corners, False
    # Of copies it is asked once, however many there are.
    volumes = np.concatenate([native.shape_of(mesh)[0] * np.abs(np.linalg.det(placings[:, :3, :3]))
                              for mesh, placings in bodies])
    number = int(np.argsort(volumes, kind="stable")[len(volumes) // 2])
    for mesh, placings in bodies:
        if number < len(placings):
            break
        number -= len(placings)
    own, _, triangles = mesh.arrays()
    linear, place = placings[number, :3, :3], placings[number, :3, 3]
    return own @ linear.T + place, triangles.astype(np.int32), len(volumes) > 1


_seen = {}  # {key of a mesh object: what was Seen}, for the last one: panels are drawn often


def _as_seen(thing):
    """_look_at, but of a mesh as it was when its numbers were others."""
    if thing is None or thing.type != "MESH":
        return None
    key = (thing.name_full, thing.data.name_full, len(thing.data.vertices), len(thing.data.polygons),
           len(thing.modifiers), *map(tuple, thing.matrix_world.to_3x3()))
    if key not in _seen:
        _seen.clear()
        _seen[key] = _look_at(thing)
    return _seen[key]


def _sizes(thing):
    seen = _as_seen(thing)
    return seen.sizes if seen is not None and seen.is_one_of_many else tuple(thing.dimensions)


def advise(material, thing, millimetres_per_unit, tolerance=advice.TOLERANCE, look_at=_look_at):
    """advice.Advice for a mesh object of this material, or the grains that it has; None for what has no volume or none
    of it. tolerance: in %."""
    seen = look_at(thing) if thing is not None and _is_on(material, thing) else None
    if seen is None:
        return None
    try:
        native = native_module.get()
        grain = export.material_values(material, millimetres_per_unit).to_native(native)
        return advice.advise(native, grain, *seen.shape, tolerance)
    except _sentences():
        return None


def advise_as_seen(material, thing, millimetres_per_unit, tolerance):
    """advise, fast enough for a panel."""
    return advise(material, thing, millimetres_per_unit, tolerance, _as_seen)


class MESOGRAIN_OT_choose_model(OnActiveMaterial, bpy.types.Operator):
    bl_idname = "mesograin.choose_model"
    bl_label = "Choose Model"
    bl_description = ("Take the cheapest model whose measured error is under "
                      f"{advice.TOLERANCE:g} % for this object's size, shape and medium, or under that which Render, "
                      "Sampling, Until asks for")
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        material = active_material(context)
        settings = context.scene.mesograin
        advised = advise(material, context.object, settings.millimetres_per_unit, budgets.tolerance(settings))
        if advised is None:
            name = context.object.name
            self.report({"WARNING"}, f"'{name}' encloses nothing: a grain needs a mesh with a volume."
                        if _is_on(material, context.object) else
                        f"No face of '{name}' is of '{material.name}': its grains are elsewhere, and not measured.")
            material.mesograin.model = models.PREFERRED
            return {"FINISHED"}
        material.mesograin.model = advised.model
        self.report({"INFO"}, advised.sentence)
        return {"FINISHED"}


def draw(layout, look):
    """The rows that stand for sigma_s, sigma_a and scale."""
    layout.prop(look, "colour")
    draw_channels(layout, look, "mean_free_path", "Path")


def draw_channels(layout, owner, name, text):
    """Three numbers that are no colour: a row each, which says of which channel it is."""
    column = layout.column(align=True)
    for index, label in enumerate((f"{text} R", "G", "B")):
        column.prop(owner, name, index=index, text=label)


_register_classes, _unregister_classes = bpy.utils.register_classes_factory((LookProperties, MESOGRAIN_OT_choose_model))


def register():
    _register_classes()
    bpy.types.Material.mesograin_look = PointerProperty(type=LookProperties, override=OVERRIDABLE)


def unregister():
    del bpy.types.Material.mesograin_look
    _unregister_classes()

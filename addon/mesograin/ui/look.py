# A grain as an artist says it: material.mesograin_look, kept in step with material.mesograin by being computed from it.
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
    """mm of a bpy.types.Object of this material, in its longest direction; 0 of what is none."""
    return max(thing.dimensions) * millimetres_per_unit if _is_on(material, thing) else 0.0


def hint(material, thing, millimetres_per_unit):
    """A sentence on how thick a bpy.types.Object of this material is for light; empty where there is nothing to say."""
    if not _is_on(material, thing):
        return ""
    paths = _paths(material.mesograin_look)
    sizes = [size * millimetres_per_unit for size in thing.dimensions]
    thick = thick_layer.thickness(sizes, paths)
    if not thick > 0.0 or sorted(paths)[1] >= thick_layer.LONGEST:
        return ""
    return f"{thick:.2g} mean free paths thick: {thick_layer.looks(thick)}."


def _shape(thing):
    """(volume, area, whether it is closed) of a mesh object in the scene's units."""
    if thing is None or thing.type != "MESH" or not thing.data.polygons:
        return None
    mesh = thing.data
    mesh.calc_loop_triangles()
    corners = np.empty(3 * len(mesh.loop_triangles), dtype=np.int32)
    mesh.loop_triangles.foreach_get("vertices", corners)
    places = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", places)
    linear = np.array(thing.matrix_world.to_3x3(), dtype=np.float64)
    a, b, c = (places.reshape(-1, 3).astype(np.float64) @ linear.T)[corners.reshape(-1, 3)].transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    volume = abs(np.einsum("ij,ij->", a, normals)) / 6.0
    area = 0.5 * np.linalg.norm(normals, axis=1).sum()
    edges = np.sort(corners.reshape(-1, 3)[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    closed = bool((np.unique(edges, axis=0, return_counts=True)[1] == 2).all())
    return (volume, area, closed) if volume > 0.0 and area > 0.0 else None


_seen = {}  # {key of a mesh object: its shape}, for the last one: panels are drawn often


def _shape_as_seen(thing):
    """_shape, but of a mesh as it was when its numbers were others."""
    if thing is None or thing.type != "MESH":
        return None
    key = (thing.name_full, thing.data.name_full, len(thing.data.vertices), len(thing.data.polygons),
           *map(tuple, thing.matrix_world.to_3x3()))
    if key not in _seen:
        _seen.clear()
        _seen[key] = _shape(thing)
    return _seen[key]


def advise(material, thing, millimetres_per_unit, tolerance=advice.TOLERANCE, shape_of=_shape):
    """advice.Advice for a mesh object of this material; None for what has no volume or none of it. tolerance: in %."""
    shape = shape_of(thing) if thing is not None and _is_on(material, thing) else None
    if shape is None:
        return None
    try:
        native = native_module.get()
        grain = export.material_values(material, millimetres_per_unit).to_native(native)
        return advice.advise(native, grain, *shape, tolerance)
    except _sentences():
        return None


def advise_as_seen(material, thing, millimetres_per_unit, tolerance):
    """advise, fast enough for a panel."""
    return advise(material, thing, millimetres_per_unit, tolerance, _shape_as_seen)


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

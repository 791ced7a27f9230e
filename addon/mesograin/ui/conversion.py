# From Cycles' nodes to a grain and back, so that switching engines shows the same material.
import bpy

from ..cycles import nodes, reading, recipes, shading
from ..cycles.grain_values import GrainValues
from ..scene import export
from ..schema import models, parameters
from .active_material import OnActiveMaterial, active_material


def to_grain(material, millimetres_per_unit):
    """Makes a material the grain that its Cycles nodes are, of the model that it had if that answers such grains;
    returns what is lost. Raises reading.NoGrain."""
    values, lost = reading.read(material)
    model = material.mesograin.model
    if models.CHOICES[model].translucent and values["boundary"] in parameters.boundaries_of(model):
        values["model"] = model
    for name, value in values.items():
        if name in ("sigma_a", "sigma_s"):
            value = tuple(channel / millimetres_per_unit for channel in value)
        setattr(material.mesograin, name, value)
    material.mesograin_look.forget_surroundings()
    return lost


def kind_of(grain):
    """The recipe whose tree means the same as a grain."""
    if grain.model == "lambert":
        return "diffuse"
    if grain.model == "conductor":
        return "glossy"
    by_boundary = {"dielectric": "volume_dielectric", "index_matched": "volume_index_matched"}
    return by_boundary.get(grain.boundary, "subsurface")


def _facets(glass):
    """The distribution of a rough Glass BSDF. Plain GGX loses what meets a second facet: in a heap of sugar, whose
    light meets hundreds of surfaces, a quarter of all light."""
    known = {item.identifier for item in glass.bl_rna.properties["distribution"].enum_items}
    return "MULTI_GGX" if "MULTI_GGX" in known else "GGX"


def to_cycles(material, millimetres_per_unit):
    """Replaces a material's Cycles nodes by those that mean the same as its grain; returns what is lost."""
    grain = material.mesograin
    kind = kind_of(grain)
    values = GrainValues.from_parameters(dict(export.material_values(material, millimetres_per_unit).values))
    nodes.build_into(material, recipes.recipe(kind, values, nodes.features()))
    lost = []
    if kind == "volume_dielectric" and grain.roughness > 0.0:
        for node in material.node_tree.nodes:
            if node.type == "BSDF_GLASS":
                node.distribution = _facets(node)
                node.inputs["Roughness"].default_value = grain.roughness**0.5
    if kind == "volume_dielectric":
        lost.append("light through glass, which Cycles finds only by caustics: use wide lights")
    keeps_light = _shaded_both_ways(material) if kind.startswith("volume") else None
    if keeps_light:
        lost.append(f"light in '{keeps_light}', which Cycles never lets out by flat faces where it came in by smooth "
                    "ones: shade all of them one way")
    return lost


def _shaded_both_ways(material):
    """The name of an object that wears a material on such faces, or None; each mesh is looked at once."""
    worn = {thing.data: thing.name for thing in bpy.data.objects
            if thing.type == "MESH" and any(slot.material == material for slot in thing.material_slots)}
    return next((name for mesh, name in worn.items() if shading.both_ways(mesh)), None)


class _Converts(OnActiveMaterial):
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        material = active_material(context)
        try:
            lost = self.convert(material, context.scene.mesograin.millimetres_per_unit)
        except (reading.NoGrain, ValueError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        if lost:
            self.report({"WARNING"}, f"'{material.name}' is converted but for {'; '.join(lost)}.")
        return {"FINISHED"}


class MESOGRAIN_OT_from_cycles(_Converts, bpy.types.Operator):
    bl_idname = "mesograin.from_cycles"
    bl_label = "Grain from Cycles Nodes"
    bl_description = "Make it the grain that its Cycles nodes are: a volume, Subsurface Scattering, or Principled"
    convert = staticmethod(to_grain)


class MESOGRAIN_OT_to_cycles(_Converts, bpy.types.Operator):
    bl_idname = "mesograin.to_cycles"
    bl_label = "Cycles Nodes from Grain"
    bl_description = "Replace its Cycles nodes by those that mean the same as the grain"
    convert = staticmethod(to_cycles)


class MESOGRAIN_MT_conversion(bpy.types.Menu):
    bl_idname = "MESOGRAIN_MT_conversion"
    bl_label = "Convert"

    def draw(self, _context):
        self.layout.operator(MESOGRAIN_OT_from_cycles.bl_idname)
        self.layout.operator(MESOGRAIN_OT_to_cycles.bl_idname)


register, unregister = bpy.utils.register_classes_factory(
    (MESOGRAIN_OT_from_cycles, MESOGRAIN_OT_to_cycles, MESOGRAIN_MT_conversion))

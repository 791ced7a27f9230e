# Measured materials that an artist starts from: the table of Jensen, Marschner, Levoy and Hanrahan.
import typing

import bpy
from bpy.props import EnumProperty

from ..schema import models


class Measured(typing.NamedTuple):
    """One row: reduced scattering and absorption for R, G and B in 1/mm, and the relative index of refraction."""

    name: str
    sigma_s_reduced: tuple
    sigma_a: tuple
    eta: float = 1.3


# Jensen et al., "A Practical Model for Subsurface Light Transport", SIGGRAPH 2001, figure 5. The paper gives one index,
# 1.3, and 1.5 for marble, which reproduces its column of diffuse reflectances.
TABLE = (
    Measured("Apple", (2.29, 2.39, 1.97), (0.0030, 0.0034, 0.046)),
    Measured("Chicken 1", (0.15, 0.21, 0.38), (0.015, 0.077, 0.19)),
    Measured("Chicken 2", (0.19, 0.25, 0.32), (0.018, 0.088, 0.20)),
    Measured("Cream", (7.38, 5.47, 3.15), (0.0002, 0.0028, 0.0163)),
    Measured("Ketchup", (0.18, 0.07, 0.03), (0.061, 0.97, 1.45)),
    Measured("Marble", (2.19, 2.62, 3.00), (0.0021, 0.0041, 0.0071), 1.5),
    Measured("Potato", (0.68, 0.70, 0.55), (0.0024, 0.0090, 0.12)),
    Measured("Skim milk", (0.70, 1.22, 1.90), (0.0014, 0.0025, 0.0142)),
    Measured("Skin 1", (0.74, 0.88, 1.01), (0.032, 0.17, 0.48)),
    Measured("Skin 2", (1.09, 1.59, 1.79), (0.013, 0.070, 0.145)),
    Measured("Spectralon", (11.6, 20.4, 14.9), (0.0, 0.0, 0.0)),
    Measured("Whole milk", (2.55, 3.21, 3.77), (0.0011, 0.0024, 0.014)),
)
BY_IDENTIFIER = {row.name.lower().replace(" ", "_"): row for row in TABLE}


class MESOGRAIN_OT_apply_preset(bpy.types.Operator):
    bl_idname = "mesograin.apply_preset"
    bl_label = "Apply Measured Material"
    bl_description = ("Set sigma_s, sigma_a and eta to a measured material's, and g to 0 because the table gives "
                      "reduced scattering")
    bl_options = {"REGISTER", "UNDO"}

    preset: EnumProperty(name="Material", items=tuple(
        (identifier, row.name, f"sigma_s' {row.sigma_s_reduced}, sigma_a {row.sigma_a} in 1/mm, eta {row.eta}", number)
        for number, (identifier, row) in enumerate(BY_IDENTIFIER.items())))

    @classmethod
    def poll(cls, context):
        return getattr(context, "material", None) is not None or (
            context.object is not None and context.object.active_material is not None)

    def execute(self, context):
        material = getattr(context, "material", None) or context.object.active_material
        apply(BY_IDENTIFIER[self.preset], material.mesograin)
        return {"FINISHED"}


def apply(row, grain):
    """Sets the material properties `grain` to a row of the table, and makes it translucent if it was not."""
    grain.sigma_s = row.sigma_s_reduced
    grain.sigma_a = row.sigma_a
    grain.g = 0.0
    grain.eta = row.eta
    grain.scale = 1.0
    if grain.model in models.OPAQUE:
        grain.model = "model_1"


class MESOGRAIN_MT_presets(bpy.types.Menu):
    bl_idname = "MESOGRAIN_MT_presets"
    bl_label = "Measured Materials"

    def draw(self, _context):
        self.layout.operator_enum(MESOGRAIN_OT_apply_preset.bl_idname, "preset")


register, unregister = bpy.utils.register_classes_factory((MESOGRAIN_OT_apply_preset, MESOGRAIN_MT_presets))

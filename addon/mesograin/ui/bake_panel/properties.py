# What a scene remembers of how a surface is to be baked: scene.mesograin_bake.
import bpy
from bpy.props import BoolProperty, EnumProperty, IntProperty, StringProperty

from ... import compat
from ...cycles import kinds
from ...schema import labels
from ...studies.baking import choices
from ..side_task.settings import remembered_by_scenes

VIEWS = {
    "above_surface": ("Above Surface", "Every texel is looked at along its normal"),
    "active_camera": ("Active Camera", "From the camera; what it does not see is looked at from low above"),
}


USUAL = "usual"
"""The choice of a reference that leaves it to the model."""


class BakeProperties(bpy.types.PropertyGroup):
    """`scene.mesograin_bake`."""

    width: IntProperty(name="Width", default=1024, min=1, max=choices.LARGEST_SIDE, description="Texels across")
    height: IntProperty(name="Height", default=1024, min=1, max=choices.LARGEST_SIDE, description="Texels up")
    samples: IntProperty(name="Samples", default=choices.SAMPLES, min=1, max=1 << 20, soft_max=4096,
                         description="Samples of each texel")
    view_from: EnumProperty(
        name="View from", default=choices.VIEW_FROM[0], description="What looks at the surface",
        items=tuple((name, *VIEWS[name], number) for number, name in enumerate(choices.VIEW_FROM)))
    margin: IntProperty(name="Margin", default=choices.DEFAULT_MARGIN, min=0, max=choices.LARGEST_MARGIN, soft_max=64,
                        description="Texels by which what is baked reaches beyond the UVs")
    half: BoolProperty(name="Half floats", default=False, description="16-bit instead of 32-bit floats")
    relightable: BoolProperty(
        name="Relightable", default=False,
        description="For light from anywhere, not the scene's: textures, each of which counts as much as the light's "
        "direction says, with a node group for Cycles and EEVEE, a recipe in GLSL, and the error over 64 directions")
    components: IntProperty(
        name="Components", default=choices.DEFAULT_COMPONENTS, min=choices.FEWEST_COMPONENTS,
        max=choices.LARGEST_COMPONENTS, description="Textures of a relightable bake: more are more exact")
    direction_samples: IntProperty(
        name="Samples of a Direction", default=choices.SAMPLES_OF_A_DIRECTION, min=1, max=1 << 20, soft_max=64,
        description="Samples of each texel, for each direction that a relightable bake is lit from")
    compare: BoolProperty(
        name="Compare with Cycles", default=False,
        description="Bake besides, in a Blender of its own, what can be compared with Cycles, and Cycles' bake of it, "
        "and measure the difference")
    # Their numbers are those of the table, so that files keep their choice when there are more.
    reference: EnumProperty(
        name="Reference", default=USUAL, description="What Cycles solves",
        items=((USUAL, "The Model's Usual", "What answers the material's model", 0), *(
            (kind.name, kind.label, f"Answers {', '.join(map(labels.of_model, kind.models))}", number)
            for number, kind in enumerate(kinds.KINDS.values(), 1) if kind.has_texture)))
    reference_samples: IntProperty(
        name="Cycles Samples", default=0, min=0, max=1 << 20, soft_max=4096,
        description="Cycles' samples of each texel, for each of two seeds; 0 is 64 for surfaces and 128 for volumes")
    out: StringProperty(name="File", default="//bake.exr", subtype="FILE_PATH", **compat.relative_path_options(),
                        description="The EXR file to write; // is the folder of the .blend file")


register, unregister = remembered_by_scenes("mesograin_bake", BakeProperties)

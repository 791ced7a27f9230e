# What a scene remembers of how its grains are to be matched: scene.mesograin_match.
import bpy
from bpy.props import BoolProperty, EnumProperty, IntProperty, PointerProperty, StringProperty

from ... import compat
from ...cycles import kinds
from ...schema.parameters import PARAMETERS
from ...studies.match import choices
from ..side_task.settings import remembered_by_scenes

AS_MATERIAL = "material"
"""The choice of a reference that leaves it to the material."""


class MatchProperties(bpy.types.PropertyGroup):
    """`scene.mesograin_match`."""

    image: PointerProperty(
        name="Picture", type=bpy.types.Image,
        description="What the grains are to look like: a render in linear radiance (OpenEXR), or a photograph in sRGB,"
        " seen by this scene's camera in its lights")
    parameters: EnumProperty(
        name="Search for", options={"ENUM_FLAG"}, default=set(choices.COEFFICIENTS),
        items=tuple((name, PARAMETERS[name].label, PARAMETERS[name].sentence, 1 << number)
                    for number, name in enumerate(choices.PARAMETERS)),
        description="What is searched for; the rest stays as the material says (Shift adds to the choice)")
    # Their numbers are those of the table, so that files keep their choice when there are more.
    reference: EnumProperty(
        name="Made by", default=AS_MATERIAL, description="What the picture is of",
        items=((AS_MATERIAL, "This Grain", "A grain with the boundary that the material says", 0), *(
            (name, kinds.KINDS[name].label, f"Cycles rendered it with {kinds.KINDS[name].title}", number)
            for number, name in enumerate(kinds.KINDS, 1) if name in choices.REFERENCES)))
    corrections: IntProperty(
        name="Cycles Checks", default=choices.CORRECTIONS, min=0, max=choices.MOST_CORRECTIONS,
        description="How often, at most, Cycles renders what was found, to correct our model by what it is off there")
    free_exposure: BoolProperty(
        name="Exposure Unknown", default=False,
        description="The picture is as bright as the scene up to a factor, which is found, too: for photographs")
    size: IntProperty(
        name="Size", default=choices.Asked.size, min=32, max=4096, soft_max=512, subtype="PIXEL",
        description="Longer side of what is drawn and compared")
    out: StringProperty(
        name="Folder", default="//match", subtype="DIR_PATH", **compat.relative_path_options(),
        description="Where match.json and the pictures go; // is the folder of the .blend file")


def arguments(scene):
    """The arguments of `studies.match.run.match_image` that a scene asks for, but for folders and material."""
    asked = scene.mesograin_match
    return {
        "image": asked.image.name,
        "parameters": [name for name in choices.PARAMETERS if name in asked.parameters],
        "reference": None if asked.reference == AS_MATERIAL else asked.reference,
        "corrections": 0 if asked.reference == AS_MATERIAL else asked.corrections,
        "exposure": "free" if asked.free_exposure else "known",
        "size": asked.size,
    }


register, unregister = remembered_by_scenes("mesograin_match", MatchProperties)

# What a scene remembers of how it is to be compared: scene.mesograin_compare.
import dataclasses

import bpy
from bpy.props import EnumProperty, IntProperty, StringProperty

from ... import compat
from ...cycles import kinds
from ...schema import labels, models
from ..side_task.settings import remembered_by_scenes


@dataclasses.dataclass(frozen=True)
class Quality:
    """samples: of each pixel on our side. reference_samples: for each seed; None for the kind's own default."""

    label: str
    samples: int
    reference_samples: int


QUALITIES = {
    "draft": Quality("Draft", 16, 16),
    "normal": Quality("Normal", 64, None),
    "final": Quality("Final", 256, 512),
}


AUTO_FLAG = 1 << 20
"""In a file: beyond those of all models that may come."""


def _flags(items):
    """Items of an enum of which several can be chosen: their numbers are bits."""
    return tuple((name, label, description, 1 << number) for number, (name, label, description) in enumerate(items))


def _describe(quality):
    theirs = quality.reference_samples or "64 (surfaces) or 128 (volumes)"
    return f"{quality.samples} samples of each pixel on our side, {theirs} for each seed of Cycles"


class CompareProperties(bpy.types.PropertyGroup):
    """`scene.mesograin_compare`."""

    models: EnumProperty(
        name="Models", options={"ENUM_FLAG"}, default=set(models.WITH_LOBES),
        items=(*_flags([(model.name, model.label, model.sentence) for model in models.MODELS.values()]),
               (models.AUTO.name, models.AUTO.label, models.AUTO.sentence, AUTO_FLAG)),
        description="Models to compare; every material of the scene is rendered with each (Shift adds to the choice)")
    references: EnumProperty(
        name="References", options={"ENUM_FLAG"}, default=set(),
        items=_flags([(kind.name, kind.label, f"Answers {', '.join(map(labels.of_model, kind.models))}")
                      for kind in kinds.KINDS.values()]),
        description="What Cycles renders to compare with; none chosen is each model's usual one")
    quality: EnumProperty(
        name="Quality", default="draft", description="How many samples both sides take",
        items=tuple((name, quality.label, _describe(quality), number)
                    for number, (name, quality) in enumerate(QUALITIES.items())))
    size_percent: IntProperty(
        name="Size", default=25, min=1, max=100, subtype="PERCENTAGE",
        description="Size of the pictures, of the scene's resolution; at least 8 pixels a side")
    out: StringProperty(
        name="Folder", default="//comparison", subtype="DIR_PATH", **compat.relative_path_options(),
        description="Where pictures, results.json, results.csv and report.html go; // is the folder of the .blend file")


def size(scene):
    """(width, height) in pixels of the pictures that a scene asks for."""
    render, percent = scene.render, scene.mesograin_compare.size_percent
    share = render.resolution_percentage * percent / 10000.0
    return max(8, round(render.resolution_x * share)), max(8, round(render.resolution_y * share))


def arguments(scene):
    """The arguments of `scripting.compare` that a scene asks for, but for its folders."""
    settings = scene.mesograin_compare
    quality = QUALITIES[settings.quality]
    # In the order of the table, which a set does not keep.
    return {
        "models": [name for name in models.CHOICES if name in settings.models],
        "references": [kind for kind in kinds.KINDS if kind in settings.references] or None,
        "size": list(size(scene)),
        "samples": quality.samples,
        "reference_samples": quality.reference_samples,
    }


register, unregister = remembered_by_scenes("mesograin_compare", CompareProperties)

# The Match to Picture panel, among a material's properties.
import math

import bpy

from ...schema import models
from ...studies.match import files
from .. import panels
from ..side_task import panel as side_task
from ..side_task import pictures
from ..widths import arrange, choose
from . import operators, properties
from .session import session

TITLES = {"sigma_s": "sigma_s 1/mm", "sigma_a": "sigma_a 1/mm", "mean_free_path": "Path mm", "g": "g",
          "exposure": "Exposure"}


def draw_settings(layout, context):
    asked = context.scene.mesograin_match
    layout.template_ID(asked, "image", open="image.open")
    layout.row().prop(asked, "parameters", expand=True)
    column = layout.column()
    arrange(column, context)
    column.use_property_decorate = False
    choose(column, asked, "reference", "Made by")
    if asked.reference != properties.AS_MATERIAL:
        column.prop(asked, "corrections", text="Checks")
    column.column(heading="Exposure").prop(asked, "free_exposure", text="Unknown")
    column.prop(asked, "size")
    column.prop(asked, "out")


def draw_results(layout, context):
    found = session.results
    if found is None:
        return
    box = layout.box()
    panels.draw_sentence(box, context, f"{found['material']}, by {models.MODELS[found['model']].label}", icon="NONE")
    for name, title in TITLES.items():
        if name in found["intervals"]:
            halves = box.split(factor=0.5)
            halves.label(text=title)
            column = halves.column(align=True)
            for entry in found["intervals"][name]:
                column.label(text=_short(name, entry))
    unknown = files.undetermined(found["intervals"])
    if unknown:
        words = "; ".join(f"{name} of {', '.join(channels)}" if len(found["intervals"][name]) == 3 else name
                          for name, channels in unknown.items())
        panels.draw_sentence(box, context, f"The picture does not determine {words}.", icon="QUESTION")
    panels.draw_sentence(box, context, f"{found['metrics']['relative_l1_blocks']:.1%} off in blocks, after"
                         f" {found['renders']} pictures.", icon="INFO")
    row = box.row(align=True)
    for picture in pictures.pictures_of(session.entry):
        row.operator(operators.MESOGRAIN_OT_show_match.bl_idname, text=operators.BUTTONS[picture][0]).picture = picture
    layout.operator(operators.MESOGRAIN_OT_apply_match.bl_idname, icon="CHECKMARK")


def _short(name, entry):
    """'2.3 ± 4 %', '0.1 ?', '≤ 0.01'; of g, '0.8 ± 0.05'."""
    if entry["bounded"]:
        return f"≤ {entry['high']:.2g}"
    if not entry["determined"]:
        return f"{entry['value']:.3g} ?"
    if name == "g":
        return f"{entry['value']:.2f} ± {0.5 * (entry['high'] - entry['low']):.2f}"
    return f"{entry['value']:.3g} ± {math.ceil(100.0 * (entry['high'] / entry['value'] - 1.0))} %"


class MESOGRAIN_PT_match(panels.MesograinPanel, bpy.types.Panel):
    bl_label = "Match to Picture"
    bl_context = about = "material"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return super().poll(context) and models.CHOICES[context.material.mesograin.model].translucent

    def draw(self, context):
        side_task.draw_settings(self.layout, context, session, draw_settings)
        side_task.draw_job(self.layout, context, session, operators.MESOGRAIN_OT_match,
                           operators.MESOGRAIN_OT_cancel_match, "the next goes on from here.", about="about ",
                           icon="EYEDROPPER")
        draw_results(self.layout, context)


register, unregister = bpy.utils.register_classes_factory((MESOGRAIN_PT_match,))

# Nowhere is an artist shown an identifier where a panel shows a label.
import itertools
import re

import bpy
import numpy as np
import pytest

from mesograin.cycles import kinds, wording
from mesograin.schema import labels, models, parameters
from mesograin.scene import export
from mesograin.studies.baking import comparison as bakes
from mesograin.studies.comparison import measure
from mesograin.studies.comparison.request import Case, Request
from mesograin.studies.trade import measure as trade

IDENTIFIERS = re.compile(r"(?<!\w)(" + "|".join(name for name in wording.LABELS if "_" in name) + r")(?!\w)")


def identifiers(text):
    return IDENTIFIERS.findall(text)


def own_classes(kind):
    return [one for one in kind.__subclasses__() if one.__module__.startswith("mesograin.")]


def texts(rna):
    """All that Blender shows of a class: label and tooltip, and those of its properties and of their choices."""
    yield from (rna.name, rna.description)
    for one in rna.properties:
        yield from (one.name, one.description)
        for item in getattr(one, "enum_items_static", ()) if one.type == "ENUM" else ():
            yield from (item.name, item.description)


@pytest.mark.parametrize("kind, least", [("Panel", 15), ("Operator", 20), ("Menu", 3), ("PropertyGroup", 8),
                                         ("AddonPreferences", 1)])
def test_no_label_and_no_tooltip_holds_an_identifier(kind, least):
    classes = own_classes(getattr(bpy.types, kind))
    assert len(classes) >= least  # else they were looked for wrongly
    assert {text: identifiers(text) for one in classes for text in texts(one.bl_rna) if identifiers(text)} == {}


@pytest.mark.parametrize("part", [None, *kinds.PARTS])
def test_progress_of_a_comparison_says_models_and_references_as_the_panel_does(part, tmp_path):
    cases = [Case(model, kind.name, part) for kind in kinds.KINDS.values() for model in kind.models
             if kinds.has(kind.name, part)]
    for case in cases:
        steps = [what for what, *_ in measure.steps(case, Request((case.model,), tmp_path, controls=True), (8, 8))]
        assert len(steps) == 3 and not any(map(identifiers, steps)), steps
        assert all(step.startswith(f"{labels.of_model(case.model)}: ") for step in steps), steps
        assert case.kind.label in steps[0] and case.kind.label in steps[2], steps


def test_progress_of_a_trade_and_of_a_bake_too(tmp_path):
    for kind in kinds.KINDS.values():
        request = trade.Request(tmp_path, kind.name, kind.models, (1,), (4,), 8, (1,), (8, 8))
        assert not any(identifiers(what) for what, *_ in trade._steps(request))
    bpy.ops.mesh.primitive_uv_sphere_add(segments=8, ring_count=4)
    thing = bpy.context.object
    thing.data.materials.append(bpy.data.materials.new("Sand"))
    thing.active_material.mesograin.model = "model_1"
    compared = bakes.Pair(bpy.context.evaluated_depsgraph_get(), thing.name, (8, 8), 1, "above_surface", {}, None, None,
                          1, None)
    assert [what for what, *_ in compared.steps] == [
        f"Cycles bakes {thing.name} (Volume, index-matched)", f"baking {thing.name} as Cycles has it"]


def test_a_choice_that_a_model_does_not_know_is_told_by_its_labels(native):
    material = bpy.data.materials.new("Sand")
    mesh = native.Mesh([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], None,
                       [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    view = native.View(4, 4)
    view.set_camera(native.Camera.look_at((0.0, 0.0, 2.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 40.0))
    choices = [[choice.name for choice in parameters.PARAMETERS[name].choices] for name in ("boundary", "profile")]
    told = set()
    for model, boundary, profile in itertools.product(models.NAMES, *choices):
        grain = material.mesograin
        grain.model, grain.boundary, grain.profile = model, boundary, profile
        values = export.material_values(material, 1.0)
        try:
            view.set_scene(native.Scene(instances=[native.Instance(mesh, native.Material(**dict(values.values)),
                                                                   np.eye(4))]))
            works = True
        except native.Error:
            works = False
        try:
            values.to_native(native)
            assert works, (model, boundary, profile)
        except native.Error as complaint:
            assert not works, (model, boundary, profile)
            told.add(str(complaint))
            assert identifiers(str(complaint)) == [] and "'Sand'" in str(complaint)
    assert "Material 'Sand': Transport takes Dielectric or Index matched as boundary; got 'Lambert, Lambert': choose " \
        "one of these." in told

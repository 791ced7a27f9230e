# What is said over a viewport fits beside what else lies there.
import types

import bpy
import pytest

from mesograin import compat
from mesograin.engine import engine, viewport_text
from mesograin.scene import export, meshes

SENTENCE = "Material 'Brick' is no grain and is drawn as a diffuse surface under a coat; left out: its texture."


def test_a_sentence_that_fits_is_said_as_it_is():
    assert viewport_text.line([SENTENCE], len(SENTENCE)) == SENTENCE


@pytest.mark.parametrize("others", [(), ("One more.",), ("One more.", "And another.")])
@pytest.mark.parametrize("fitting", [70, 80, 90])
def test_a_sentence_that_does_not_fit_says_where_all_of_it_is(others, fitting):
    said = viewport_text.line([SENTENCE, *others], fitting)
    assert len(said) <= fitting
    assert said.startswith("Material 'Brick'") and "…" in said and viewport_text.PLACE in said
    assert not others or f"and {len(others)} more" in said


@pytest.mark.parametrize("models, milliseconds, device, said", [
    (("model_2", "transport"), 70.25, "llvmpipe (LLVM 15.0.6, 256 bits)",
     "Model 2, Transport | 78 ms a sample | llvmpipe"),
    (("model_1",), 3436.0, "llvmpipe (LLVM 15.0.6, 256 bits)", "Model 1 | 3444 ms a sample | llvmpipe"),
    ((), 0.3, "NVIDIA RTX A2000/PCIe/SSE2", "8.3 ms a sample | NVIDIA RTX A2000")])
def test_facts_say_models_time_and_device(models, milliseconds, device, said):
    assert viewport_text.facts(models, (("light_maps", milliseconds), ("shade", 8.01)), device) == said


@pytest.fixture
def session():
    values = types.SimpleNamespace(models_drawn=("model_1",))
    return types.SimpleNamespace(preparing=None, samples=2, values=values, timings=(("shade", 5.0),))


def test_the_line_says_facts_where_there_is_room_beside_what_is_wrong(session, native):
    device = native.device_info()["renderer"].split("(")[0].split("/")[0].strip()
    facts = f"Sample 2/64 | Model 1 | 5 ms a sample | {device}"
    assert engine._line(session, 64, (), len(facts)) == facts
    assert engine._line(session, 64, (), len(facts) - 1) == "Sample 2/64"
    assert engine._line(session, 64, (SENTENCE,), 300) == f"{facts} | {SENTENCE}"
    narrow = engine._line(session, 64, (SENTENCE,), len(facts) + 50)
    assert narrow.startswith("Sample 2/64 | Material 'Brick'")
    session.samples, session.values = 1, None  # the first sample asks nobody
    assert engine._line(session, 64, (), 300) == "Sample 1/64"


def test_models_are_those_of_grains_as_they_are_drawn():
    for number, model in enumerate(("auto", "model_1", None)):
        bpy.ops.mesh.primitive_uv_sphere_add(segments=16, ring_count=8, location=(3.0 * number, 0.0, 0.0))
        material = bpy.data.materials.new("Sand")
        bpy.context.object.data.materials.append(material)
        if model:
            material.mesograin.model = model
            material.mesograin.sigma_s, material.mesograin.sigma_a = (3.0,) * 3, (0.1,) * 3
        else:
            compat.use_nodes(material)
    scene = export.read_scene(bpy.context.evaluated_depsgraph_get(), meshes.MeshCache())
    [chosen] = {dict(each.values)["model"] for each in scene.with_models_chosen().materials} - {"model_1", "lambert"}
    assert scene.models_drawn == tuple(sorted(("model_1", chosen))) and chosen != "auto"


def region(kind, x, width, alignment="NONE"):
    return types.SimpleNamespace(type=kind, x=x, width=width, alignment=alignment)


def context(*others, gizmo=False):
    window = region("WINDOW", 100, 600)
    return types.SimpleNamespace(
        region=window, area=types.SimpleNamespace(regions=[window, *others]),
        preferences=types.SimpleNamespace(system=types.SimpleNamespace(ui_scale=1.0)),
        space_data=types.SimpleNamespace(show_gizmo=gizmo, show_gizmo_navigate=True))


def test_toolbar_sidebar_and_gizmo_leave_less_room():
    bare = viewport_text.columns(context())
    assert bare == pytest.approx(600 / viewport_text.CHARACTER, abs=1)
    toolbar, sidebar = region("TOOLS", 100, 60, "LEFT"), region("UI", 500, 200, "RIGHT")
    assert viewport_text.columns(context(toolbar)) == pytest.approx(bare * 0.9, abs=1)
    assert viewport_text.columns(context(toolbar, sidebar)) == pytest.approx(bare * 340 / 600, abs=1)
    assert viewport_text.columns(context(gizmo=True)) < bare
    # Hidden ones, and those of areas elsewhere, take nothing.
    assert viewport_text.columns(context(region("UI", 500, 1, "RIGHT"), region("TOOLS", 900, 60, "LEFT"))) == bare

# A grain said as artists say it, in step with its coefficients; how thick it is; the model that is chosen for it.
import bpy
import numpy as np
import pytest
from mesograin import native_module
from mesograin.scene import automatic, export, heaps, meshes, properties
from mesograin.schema import advice
from mesograin.schema import presets as known
from mesograin.ui import look, presets


@pytest.fixture
def material():
    material = bpy.data.materials.new("Grain")
    presets.apply(known.BY_IDENTIFIER["apple"], material.mesograin)
    return material


def test_colour_and_path_tell_what_the_coefficients_are(material, native):
    said, grain = material.mesograin_look, material.mesograin
    assert tuple(said.mean_free_path) == pytest.approx(
        [1.0 / (a + s) for a, s in zip(grain.sigma_a, grain.sigma_s)], rel=1e-5)
    sent_back = native.half_space_albedo(native.Material(model="model_1", sigma_a=grain.sigma_a, sigma_s=grain.sigma_s,
                                                         eta=grain.eta))
    white = native.half_space_albedo(native.Material(model="model_1", sigma_a=(0.0,) * 3, sigma_s=(1.0,) * 3,
                                                     eta=grain.eta))
    assert tuple(said.colour) == pytest.approx([part / whole for part, whole in zip(sent_back, white)], abs=1e-5)


def test_a_colour_leaves_the_paths_and_a_path_the_colour(material, native):
    said = material.mesograin_look
    material.mesograin.g, material.mesograin.scale = 0.4, 3.0
    paths = tuple(said.mean_free_path)
    said.colour = (0.9, 0.5, 0.1)
    assert tuple(said.colour) == pytest.approx((0.9, 0.5, 0.1), abs=1e-3)
    assert tuple(said.mean_free_path) == pytest.approx(paths, rel=1e-4)
    said.mean_free_path = (0.5, 1.0, 2.0)
    assert tuple(said.mean_free_path) == pytest.approx((0.5, 1.0, 2.0), rel=1e-4)
    assert tuple(said.colour) == pytest.approx((0.9, 0.5, 0.1), abs=1e-3)
    assert (material.mesograin.g, material.mesograin.scale) == (pytest.approx(0.4), 3.0)


def test_a_medium_of_nothing_has_a_colour_and_a_path(material, native):
    grain, said = material.mesograin, material.mesograin_look
    grain.sigma_a = grain.sigma_s = (0.0, 0.0, 0.0)
    grain.scale = 0.0
    assert tuple(said.colour) == (0.0, 0.0, 0.0) and min(said.mean_free_path) > 1e5
    said.mean_free_path = (1.0, 1.0, 1.0)
    assert tuple(said.mean_free_path) == pytest.approx((1.0, 1.0, 1.0), rel=1e-5)
    said.colour = (0.5, 0.5, 0.5)
    assert tuple(said.colour) == pytest.approx((0.5, 0.5, 0.5), abs=1e-3)


def test_water_around_a_grain_is_taken_back(material):
    grain, said = material.mesograin, material.mesograin_look
    grain.eta = 1.544
    said.surroundings = "water"
    assert grain.eta == pytest.approx(1.544 / 1.333, rel=1e-5)
    said.surroundings = "oil"
    assert grain.eta == pytest.approx(1.544 / 1.47, rel=1e-5)
    said.surroundings = "air"
    assert grain.eta == pytest.approx(1.544, rel=1e-5)
    said.surroundings = "water"
    presets.apply(known.BY_IDENTIFIER["salt"], grain)
    assert grain.eta == pytest.approx(1.544) and said.surroundings == "air"


def test_what_a_grain_lies_in_can_be_animated(material):
    grain, said = material.mesograin, material.mesograin_look
    grain_object(material, 1.0)
    grain.eta = 1.544
    for frame, around in ((1, "air"), (11, "water"), (21, "oil")):
        said.surroundings = around
        said.keyframe_insert("surroundings", frame=frame)
    for frame, index in ((1, 1.0), (11, 1.333), (21, 1.47), (1, 1.0)):
        bpy.context.scene.frame_set(frame)
        evaluated = material.evaluated_get(bpy.context.evaluated_depsgraph_get())
        assert dict(export.material_values(evaluated, 1.0).values)["eta"] == pytest.approx(1.544 / index, rel=1e-5)


def grain_object(material, size, is_cube=False):
    make = bpy.ops.mesh.primitive_cube_add if is_cube else bpy.ops.mesh.primitive_uv_sphere_add
    make(**({"size": size} if is_cube else {"radius": 0.5 * size}))
    thing = bpy.context.object
    thing.data.materials.append(material)
    bpy.context.view_layer.update()
    return thing


def test_the_hint_knows_size_and_unit(material, native):
    path = sorted(material.mesograin_look.mean_free_path)[1]
    thing = grain_object(material, 7.0 * path)
    assert look.hint(material, thing, 1.0) == "7 mean free paths thick: light shines through its rim."
    assert "looks solid" in look.hint(material, thing, 10.0)
    assert "clear" in look.hint(material, thing, 0.1)


@pytest.mark.parametrize("paths, is_cube, model", [(8.0, False, "model_2"), (150.0, False, "model_1"),
                                                   (6.0, True, "transport")])
def test_a_model_is_chosen_by_size_and_shape(material, native, paths, is_cube, model):
    thing = grain_object(material, paths * sorted(material.mesograin_look.mean_free_path)[1], is_cube)
    advised = look.advise(material, thing, 1.0)
    assert bpy.ops.mesograin.choose_model() == {"FINISHED"}
    assert material.mesograin.model == advised.model == model
    assert advised.error <= 10.0


def test_an_open_cube_is_told_from_a_closed_one(material, native):
    thing = grain_object(material, 6.0 * sorted(material.mesograin_look.mean_free_path)[1], True)
    volume, area, closed = look._look_at(thing).shape
    assert closed and 36.0 * np.pi * volume**2 / area**3 == pytest.approx(np.pi / 6.0, rel=1e-6)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.object.mode_set(mode="OBJECT")
    thing.data.polygons[0].select = True
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.delete(type="FACE")
    bpy.ops.object.mode_set(mode="OBJECT")
    assert not look._look_at(thing).shape[2] and look.advise(material, thing, 1.0).model == "model_3"


def drawn_models():
    depsgraph = bpy.context.evaluated_depsgraph_get()
    values = export.read_scene(depsgraph, meshes.MeshCache())
    scene = values.to_native()
    asked = {dict(drawn.material.values)["model"] for drawn in (*values.instances, *values.heaps)}
    assert asked == {"auto"}, "what is asked for is what changes are told by"
    return [drawn.material.model for drawn in (*scene.instances, *scene.arrays)]


def test_auto_is_another_model_for_another_size_and_shape(material, native):
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    material = bpy.data.materials.new("Grain")
    material.mesograin.model = "auto"
    path = sorted(material.mesograin_look.mean_free_path)[1]
    for number, (paths, is_cube) in enumerate(((8.0, False), (150.0, False), (6.0, True))):
        grain_object(material, paths * path, is_cube).location.x = 1000.0 * number
    bpy.context.view_layer.update()
    assert sorted(drawn_models()) == ["model_1", "model_2", "transport"]
    # Each a hundredth as thick: of a sphere of a radius of 0.08 mean free paths model 2 is 22 % off.
    bpy.context.scene.mesograin.millimetres_per_unit = 0.01
    assert sorted(drawn_models()) == ["model_2", "transport", "transport"]


@pytest.mark.parametrize("large, model", [(60, "model_1"), (40, "model_2")])
def test_auto_of_a_heap_goes_by_its_middle_grain(material, native, large, model):
    paths = sorted(material.mesograin_look.mean_free_path)
    placings = np.tile(np.eye(4, dtype=np.float32), (100, 1, 1))
    placings[:large, :3, :3] *= 60.0 * paths[1]
    placings[large:, :3, :3] *= paths[1]
    transforms = native_module.get().Transforms(placings)
    heap = heaps.HeapValues("Heap", heaps.sphere(), export.material_values(material, 1.0), transforms)
    [drawn] = automatic.with_models([heap], advice.TOLERANCE)
    assert dict(drawn.material.values)["model"] == model and drawn.placings == heap.placings


def test_auto_keeps_its_number_in_files(material):
    item = material.mesograin.bl_rna.properties["model"].enum_items["auto"]
    assert item.value == properties.AUTO_NUMBER


def test_every_preset_can_be_applied(native):
    bpy.ops.mesh.primitive_uv_sphere_add()
    bpy.context.object.data.materials.append(bpy.data.materials.new("Grain"))
    for identifier, preset in known.BY_IDENTIFIER.items():
        assert bpy.ops.mesograin.apply_preset(preset=identifier) == {"FINISHED"}
        grain = bpy.context.object.active_material.mesograin
        assert grain.model == "auto"
        assert tuple(grain.sigma_s) == pytest.approx(preset.sigma_s)
        assert (grain.g, grain.eta, grain.roughness) == pytest.approx((preset.g, preset.eta, preset.roughness))
        assert grain.boundary == preset.boundary


def test_an_artist_s_own_preset_is_kept_and_found_again(native, tmp_path, monkeypatch):
    # Which Blender calls after the preset that was chosen last.
    monkeypatch.setattr(presets.MESOGRAIN_MT_own_presets, "bl_label", presets.MESOGRAIN_MT_own_presets.bl_label)
    monkeypatch.setattr(bpy.utils, "user_resource",
                        lambda kind, path="", create=False: str(tmp_path / kind.lower() / path))
    bpy.ops.mesh.primitive_uv_sphere_add()
    thing = bpy.context.object
    thing.data.materials.append(bpy.data.materials.new("Grain"))
    grain = thing.active_material.mesograin
    presets.apply(known.BY_IDENTIFIER["rice"], grain)
    grain.g, grain.boundary = 0.25, "index_matched"
    thing.active_material.mesograin_look.surroundings = "water"
    (tmp_path / "scripts/presets/mesograin/materials").mkdir(parents=True)
    assert bpy.ops.mesograin.add_preset(name="My rice") == {"FINISHED"}
    kept = list(tmp_path.rglob("*.py"))
    assert [path.stem for path in kept] == ["My_rice"]
    presets.apply(known.BY_IDENTIFIER["ice"], grain)
    exec(compile(kept[0].read_text(), str(kept[0]), "exec"), {"bpy": bpy})  # as script.execute_preset does in a window
    assert (grain.g, grain.boundary, grain.eta) == (pytest.approx(0.25), "index_matched", pytest.approx(1.53 / 1.333))
    assert tuple(grain.sigma_s) == pytest.approx((2.0, 2.0, 2.0))
    thing.active_material.mesograin_look.surroundings = "air"
    assert grain.eta == pytest.approx(1.53)

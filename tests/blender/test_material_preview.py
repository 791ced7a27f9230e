# What of a material's preview can be had without a window: the stage that Blender sets, as it is drawn.
import types

import bpy
import numpy as np
import pytest
from mathutils import Matrix

from mesograin.engine import material_preview, own_grain
from mesograin.scene import export, meshes


@pytest.fixture(autouse=True)
def no_sizes(monkeypatch):
    monkeypatch.setattr(material_preview, "_sizes", {})
    monkeypatch.setattr(material_preview, "_owed", set())
    monkeypatch.setattr(material_preview, "_last_read", None)
    monkeypatch.setattr(own_grain, "_grains", {})


def add(name, data, material, size=1.0):
    made = bpy.data.objects.new(name, data)
    made.matrix_world = Matrix.Diagonal((size, size, size, 1.0))
    made.data.materials.append(material)
    bpy.context.scene.collection.objects.link(made)
    return made


def cube(side):
    half = side / 2.0
    mesh = bpy.data.meshes.new("Cube")
    mesh.from_pydata([(x, y, z) for x in (-half, half) for y in (-half, half) for z in (-half, half)], [],
                     [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
    return mesh


@pytest.fixture
def grain():
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    made = bpy.data.materials.new("Grain")
    made.mesograin.model, made.mesograin.sigma_s, made.mesograin.sigma_a = "auto", (2.0, 1.0, 0.5), (0.1, 0.2, 0.4)
    return made


def staged():
    depsgraph = bpy.context.evaluated_depsgraph_get()
    return material_preview.staged(export.read_scene(depsgraph, meshes.MeshCache()), depsgraph)


def said(values):
    return dict(values.instances[0].material.values)


def test_a_grain_is_as_thick_as_it_is_large(grain):
    add("Ball", cube(0.28), grain)
    assert said(staged())["sigma_s"] == pytest.approx([each / 0.28 for each in (2.0, 1.0, 0.5)])  # of a millimetre
    material_preview.note_size("Grain", 7.0)
    assert said(staged())["sigma_a"] == pytest.approx([25.0 * each for each in (0.1, 0.2, 0.4)])


@pytest.mark.parametrize("model, drawn", [("auto", "model_3"), ("transport", "model_3"), ("model_1", "model_1")])
def test_its_model_is_one_that_is_there_at_once(grain, model, drawn):
    grain.mesograin.model = model
    add("Ball", cube(0.28), grain)
    assert said(staged())["model"] == drawn


def test_the_floor_is_seen_where_it_is_no_shadow_catcher(grain):
    add("Ball", cube(0.28), grain)
    add("Floor", cube(2.0), bpy.data.materials.new("Floor"))
    assert [drawn.name for drawn in staged().instances] == ["Ball", "Floor"]
    bpy.data.materials["Floor"].name = "FloorHidden"
    assert [drawn.name for drawn in staged().instances] == ["Ball"]


def test_sizes_are_those_of_the_scene(grain):
    add("Grain", cube(1.0), grain, size=3.0)
    bpy.context.scene.mesograin.millimetres_per_unit = 0.5
    values = export.read_scene(bpy.context.evaluated_depsgraph_get(), meshes.MeshCache())
    material_preview.note_grains(values)
    assert material_preview._sizes == {"Grain": pytest.approx(1.5 * (6.0 / 3.14159265) ** (1.0 / 3.0))}


def note_own(grain, size=3.0):
    """Of an object that is twice as long as wide: it is taken out of the scene again."""
    own = add("Own", cube(1.0), grain)
    own.matrix_world = Matrix.Translation((5.0, 0.0, 7.0)) @ Matrix.Diagonal((size, size, 2.0 * size, 1.0))
    depsgraph = bpy.context.evaluated_depsgraph_get()
    material_preview.note_object(grain, own, depsgraph)
    bpy.data.objects.remove(own)


def corners(drawn):
    matrix = np.array(drawn.object_to_world).reshape(4, 4)
    return drawn.mesh.arrays()[0] @ matrix[:3, :3].T + matrix[:3, 3]


def test_the_artists_own_stands_in_place_of_what_the_stage_shows(grain):
    note_own(grain)
    add("preview_shaderball", cube(0.28), grain)
    add("Base", cube(0.1), bpy.data.materials.new("X-Grey"))
    add("Floor", cube(2.0), bpy.data.materials.new("Floor"))
    assert [drawn.name for drawn in staged().instances] == ["preview_shaderball", "Base", "Floor"]
    grain.mesograin_preview = material_preview.OWN
    floor, own = staged().instances
    assert floor.name == "Floor"
    half = material_preview.RADIUS / 6.0 ** 0.5  # of a corner's place: 1, 1 and 2 of these
    assert corners(own).min(axis=0) == pytest.approx((-half, -half, 0.0), abs=1e-6)
    assert corners(own).max(axis=0) == pytest.approx((half, half, 4.0 * half), abs=1e-6)
    said = dict(own.material.values)
    assert said["model"] == material_preview.STAND_IN
    assert said["sigma_s"] == pytest.approx([each * 3.0 / (2.0 * half) for each in (2.0, 1.0, 0.5)])


def test_the_artists_own_is_seen_where_the_stage_has_nothing(grain):
    bare = bpy.data.meshes.new("Hair")
    bare.from_pydata([(0.0, 0.0, 0.0), (0.2, 0.0, 0.0)], [(0, 1)], [])
    add("preview_hair", bare, grain)
    assert staged().instances == ()
    note_own(grain)
    assert len(staged().instances) == 1


def test_own_grain_without_any_seen_is_blenders_shape(grain):
    grain.mesograin_preview = material_preview.OWN
    add("Ball", cube(0.28), grain)
    assert [drawn.name for drawn in staged().instances] == ["Ball"]


def test_one_that_is_changed_is_shown_anew(grain):
    note_own(grain)
    assert not material_preview._owed  # it is not shown
    grain.mesograin_preview = material_preview.OWN
    note_own(grain)
    assert not material_preview._owed  # as it was
    note_own(grain, 4.0)
    assert material_preview._owed == {"Grain"}


def test_of_an_object_of_two_materials_all_is_shown(grain):
    other = bpy.data.materials.new("Other")
    other.mesograin.model = "model_1"
    whole = add("Whole", cube(1.0), grain)
    whole.data.materials.append(other)
    whole.data.polygons[0].material_index = 1
    depsgraph = bpy.context.evaluated_depsgraph_get()
    material_preview.note_grains(export.read_scene(depsgraph, meshes.MeshCache()))
    assert sorted(mesh.triangle_count for mesh in own_grain.of("Grain").meshes) == [2, 10]
    assert own_grain.of("Other") == own_grain.of("Grain")
    own_grain.forget()
    material_preview.note_object(other, whole, depsgraph)
    assert sorted(mesh.triangle_count for mesh in own_grain.of("Other").meshes) == [2, 10]


def test_an_object_that_cannot_be_drawn_is_none(grain):
    broken = add("Broken", cube(1.0), grain)
    broken.data.vertices[0].co[0] = float("nan")
    bare = bpy.data.objects.new("Bare", cube(1.0))  # as beside a material that is pinned
    bpy.context.scene.collection.objects.link(bare)
    flat = add("Flat", cube(1.0), grain, size=0.0)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    for thing in (broken, bare, flat):
        material_preview.note_object(grain, thing, depsgraph)
        assert own_grain.of("Grain") is None


@pytest.fixture
def clock(monkeypatch):
    """Time that passes where it is waited for."""
    made = types.SimpleNamespace(now=10.0, last=lambda now: 0.0)

    def sleep(seconds):
        made.now += seconds
        monkeypatch.setattr(material_preview, "_changed", made.last(made.now))

    monkeypatch.setattr(material_preview, "time", types.SimpleNamespace(monotonic=lambda: made.now, sleep=sleep))
    monkeypatch.setattr(material_preview, "_changed", 10.0)
    return made


def test_it_waits_while_an_artist_drags(clock):
    clock.last = lambda now: min(now, 12.0)
    assert material_preview.wait_for_calm(lambda: False)
    assert clock.now == pytest.approx(12.0 + material_preview.CALM_SECONDS, abs=0.02)


def test_it_waits_no_longer_than_it_is_wanted(clock):
    clock.last = lambda now: now
    assert not material_preview.wait_for_calm(lambda: clock.now > 10.5)
    assert clock.now == pytest.approx(10.5, abs=0.02)


def test_an_icon_is_as_it_was_until_it_is_calm(clock, grain, monkeypatch):
    monkeypatch.setattr(material_preview, "_icons", {})
    assert material_preview.owe_icon("Grain", 32, 16) is None
    picture = np.ones((16, 32, 4), dtype=np.float32)
    material_preview.keep_icon("Grain", picture)
    assert material_preview.owe_icon("Grain", 32, 16) is picture
    assert material_preview.owe_icon("Grain", 32, 32) is None
    assert material_preview._pay() == material_preview.CALM_SECONDS and material_preview._owed == {"Grain"}
    clock.now = 20.0
    grain.preview_ensure()
    assert material_preview._pay() is None and not material_preview._owed


def test_only_a_grain_waits(grain):
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "POINT")))
    add("Floor", cube(2.0), bpy.data.materials.new("Floor"))
    assert material_preview.grain_on(bpy.context.evaluated_depsgraph_get()) == ""
    add("Ball", cube(0.28), grain)
    assert material_preview.grain_on(bpy.context.evaluated_depsgraph_get()) == "Grain"

# Depth, Position and Normal beside the picture: in a multi-layer file, against geometry and against Cycles.
import json

import bpy
import numpy as np
import pytest
from mesograin import compat
from mesograin.engine import grace, identities, passes
from test_export import add_camera, add_sun
from test_final_render import compositor_tree

SIDE = 33


@pytest.fixture
def layers(native, tmp_path):
    """Renders into an EXR of many layers; {pass: (h, w, channels) float32, row 0 at the top}."""

    def do(depth="32"):
        scene = bpy.context.scene
        compat.ask_for_layers(scene.render.image_settings)
        scene.render.image_settings.color_depth = depth
        scene.render.filepath = str(tmp_path / "layers.exr")
        bpy.ops.render.render(write_still=True)
        pixels, channels, _ = native.read_exr(str(tmp_path / "layers.exr"))
        found = {}
        for at, channel in enumerate(channels):
            *_, name, part = channel.split(".")
            found.setdefault(name, {})[part.upper()] = pixels[..., at]
        order = "XYZRGBA"
        return {name: np.stack([parts[part] for part in sorted(parts, key=order.find)], axis=-1)
                for name, parts in found.items()}

    return do


def scene_of_a_sphere(engine="MESOGRAIN", ortho=False):
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    scene, layer = bpy.context.scene, bpy.context.view_layer
    scene.render.engine = engine
    scene.render.resolution_x = scene.render.resolution_y = SIDE
    scene.mesograin.samples = 4
    bpy.ops.mesh.primitive_uv_sphere_add(segments=256, ring_count=128, radius=1.0, location=(1000.0, 0.0, 0.0))
    bpy.ops.object.shade_smooth()
    add_camera((1000.0, 0.0, 4.0), **({"type": "ORTHO", "ortho_scale": 2.5} if ortho else {}))
    add_sun((0.3, 0.2, 1.0), 3.0)
    for one in passes.SURFACES:
        setattr(layer, one.asked_for, True)
    return scene


@pytest.mark.parametrize("ortho", [False, True])
def test_passes_are_a_sphere_s(layers, ortho):
    scene_of_a_sphere(ortho=ortho)
    found = layers()
    place, normal, depth = (found[name].astype(np.float64) for name in ("Position", "Normal", "Depth"))
    seen = depth[..., 0] < 1e9
    assert 0.2 < seen.mean() < 0.9
    np.testing.assert_allclose(depth[~seen], passes.NOWHERE)
    assert not place[~seen].any() and not normal[~seen].any()
    local = place[seen] - (1000.0, 0.0, 0.0)
    # 1000 units from the origin floats are told apart by 6e-5.
    np.testing.assert_allclose(np.linalg.norm(local, axis=-1), 1.0, atol=1e-3)
    np.testing.assert_allclose(normal[seen], local, atol=6e-3)
    np.testing.assert_allclose(depth[seen][:, 0], 4.0 - local[:, 2], atol=2e-4)
    middle = SIDE // 2
    np.testing.assert_allclose(place[middle, middle], (1000.0, 0.0, 1.0), atol=1e-3)
    # Upwards in the picture is along y.
    rows = np.nonzero(seen[:, middle])[0]
    assert place[rows[0], middle, 1] > 0.5 and place[rows[-1], middle, 1] < -0.5


def test_passes_are_those_of_cycles(layers):
    scene_of_a_sphere()
    ours = layers()
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 1
    scene.cycles.use_denoising = False
    theirs = layers()
    both = (ours["Depth"][..., 0] < 1e9) & (theirs["Depth"][..., 0] < 1e9)
    assert both.mean() > 0.9 * (ours["Depth"][..., 0] < 1e9).mean()
    # Cycles takes them at its first sample's place, which is within the pixel.
    for one in passes.SURFACES:
        apart = np.abs(ours[one.name][both] - theirs[one.name][both])
        assert np.median(apart, axis=0).max() < 0.05, one.name


def test_only_what_is_asked_for_is_there(layers):
    scene_of_a_sphere()
    bpy.context.view_layer.use_pass_position = bpy.context.view_layer.use_pass_normal = False
    assert set(layers()) == {"Combined", "Depth"}


def test_instances_of_an_array_have_passes_too(layers, native):
    scene = scene_of_a_sphere()
    thing = next(thing for thing in scene.objects if thing.type == "MESH")
    for number in range(12):
        copy = thing.copy()
        copy.scale = (0.1, 0.1, 0.1)
        copy.location = (1000.0 + 0.25 * (number % 4 - 1.5), 0.25 * (number // 4 - 1), 2.0)
        scene.collection.objects.link(copy)
    bpy.data.objects.remove(thing)
    found = layers()
    seen = found["Depth"][..., 0] < 1e9
    assert 0.005 < seen.mean() < 0.5
    assert found["Depth"][seen].min() == pytest.approx(1.9, abs=5e-3)
    assert np.abs(np.linalg.norm(found["Normal"][seen], axis=-1) - 1.0).max() < 1e-3
    assert np.abs(found["Position"][seen][:, 2] - 2.0).max() < 0.11


def scene_of_two(tmp_path, engine="MESOGRAIN"):
    """A sphere in front of a cube, each with a material and numbers of its own; one stands at the picture's edge."""
    scene = scene_of_a_sphere(engine)
    sphere = next(thing for thing in scene.objects if thing.type == "MESH")
    bpy.ops.mesh.primitive_cube_add(size=1.5, location=(1000.9, 0.4, -1.0))
    cube = bpy.context.object
    for number, (thing, name) in enumerate(((sphere, "Sand"), (cube, "Körner, gröber")), 3):
        thing.name = f"{name} thing"
        thing.pass_index = number
        thing.data.materials.append(bpy.data.materials.new(name))
        thing.active_material.pass_index = 10 * number
    layer = bpy.context.view_layer
    for name in ("object_index", "material_index", "cryptomatte_object", "cryptomatte_material"):
        setattr(layer, f"use_pass_{name}", True)
    layer.pass_cryptomatte_depth = 4
    return scene


def mattes(found, kind):
    """{id: (h, w) coverage} of CryptoObject or CryptoMaterial."""
    shares = {}
    for number in range(2):
        layer = found[f"{kind}{number:02d}"]
        for at in (0, 2):
            for one in np.unique(layer[..., at].view(np.uint32)):
                here = layer[..., at].view(np.uint32) == one
                shares[one] = shares.get(one, 0.0) + np.where(here, layer[..., at + 1], 0.0)
    shares.pop(0, None)
    return shares


def test_indices_and_mattes_are_those_of_cycles(layers, tmp_path):
    scene = scene_of_two(tmp_path)
    ours = layers()
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.use_adaptive_sampling = 64, False, False
    scene.cycles.pixel_filter_type = "BOX"
    theirs = layers()
    for name, numbers in zip(compat.names_of_index_passes(), ({0, 3, 4}, {0, 30, 40})):
        assert set(np.unique(ours[name])) == numbers
        assert (ours[name] == theirs[name]).mean() > 0.93, name  # Cycles' are those of a sample somewhere in the pixel
    for kind in ("CryptoObject", "CryptoMaterial"):
        mine, yours = mattes(ours, kind), mattes(theirs, kind)
        assert set(mine) == set(yours) and len(mine) == 2
        for one, share in mine.items():
            assert 0.02 < ((share > 0.0) & (share < 1.0)).mean() < 0.3, "an edge is partly covered"
            assert np.abs(share - yours[one]).max() < 0.3 and np.abs(share - yours[one]).mean() < 0.01


def test_mattes_say_their_names_in_the_file(layers, native, tmp_path):
    scene_of_two(tmp_path)
    layers()
    _, _, attributes = native.read_exr(str(tmp_path / "layers.exr"))
    found = {key: value for key, value in attributes.items() if key.startswith("cryptomatte/")}
    assert sorted(key.split("/")[2] for key in found) == sorted(["name", "hash", "conversion", "manifest"] * 2)
    manifests = [json.loads(value) for key, value in found.items() if key.endswith("manifest")]
    assert {name for each in manifests for name in each} == {
        "Sand", "Körner, gröber", "Sand thing", "Körner, gröber thing"}
    assert sorted(value.split(".")[1] for key, value in found.items() if key.endswith("name")) == [
        "CryptoMaterial", "CryptoObject"]


def test_half_floats_keep_mattes(layers, tmp_path):
    scene_of_two(tmp_path)
    whole, halves = layers(), layers("16")
    for name in ("CryptoObject00", "CryptoMaterial00"):
        np.testing.assert_array_equal(halves[name], whole[name])


def test_a_cancelled_render_s_mattes_are_of_the_samples_that_there_was_time_for(layers, tmp_path, monkeypatch):
    drawn = []
    monkeypatch.setattr(grace.Grace, "is_over", lambda _: len(drawn) == 3)
    taken = identities._total
    monkeypatch.setattr(identities, "_total", lambda *arguments: drawn.append(taken(*arguments)) or drawn[-1])
    scene_of_two(tmp_path)
    found = layers()
    assert len(drawn) == 3
    for share in mattes(found, "CryptoObject").values():
        assert set(np.unique(np.round(3.0 * share, 4))) == {0.0, 1.0, 2.0, 3.0}
    assert found[passes.OBJECT_INDEX.name].max() > 0.0


def test_a_render_cancelled_before_its_mattes_has_all_else(layers, tmp_path, monkeypatch):
    def give_up(*_):
        raise grace.GivenUp

    scene_of_two(tmp_path)
    whole = layers()
    monkeypatch.setattr(grace.Grace, "result", give_up)
    found = layers()
    assert set(found) == set(whole) and not mattes(found, "CryptoObject")
    for name in ("Combined", "Depth", "Normal"):
        assert whole[name].any() and np.array_equal(found[name], whole[name]), name


@pytest.mark.parametrize("name, bits", [("", 0), ("hello", 0x248BFA47), ("hello, world", 0x149BBB7F),
                                        ("The quick brown fox jumps over the lazy dog", 0x2E4FF723)])
def test_a_name_s_hash_is_murmur_s(name, bits):
    assert identities.hash_of(name) == bits


def test_the_sample_count_is_told(layers):
    scene_of_a_sphere()
    cycles = getattr(bpy.context.view_layer, "cycles", None)
    if cycles is None:
        pytest.skip("Cycles, which keeps the setting, is not there")
    cycles.pass_debug_sample_count = True
    assert set(np.unique(layers()["Debug Sample Count"])) == {4.0}


def test_ranks_are_by_share():
    numbers = np.array([1, 2, 2, 0, 3, 2, 1, 0]).reshape(8, 1, 1)
    ids, shares = identities.ranked(numbers, np.array([0, 1, 2, 3]), 4)
    assert ids.ravel().tolist() == [2, 1, 3, 0] and shares.ravel().tolist() == [0.375, 0.25, 0.125, 0.0]
    ids, shares = identities.ranked(numbers, np.array([0, 1, 1, 2]), 2)
    assert ids.ravel().tolist() == [1, 2] and shares.ravel().tolist() == [0.625, 0.125]


def ask_for_light():
    layer = bpy.context.view_layer
    for one in passes.PORTIONS.values():
        *owner, name = one.asked_for.split(".")
        setattr(layer.mesograin if owner else layer, name, True)


def test_the_light_s_portions_are_the_picture_together(layers, tmp_path):
    scene = scene_of_two(tmp_path)
    for number, material in enumerate(bpy.data.materials):
        material.mesograin.model = ("model_1", "conductor")[number % 2]
    scene.world = bpy.data.worlds.new("Sky")
    if compat.has_choice_of_nodes(scene.world):
        scene.world.use_nodes = False
        scene.world.color = (0.2, 0.3, 0.5)
    ask_for_light()
    found = layers()
    portions = [found[one.name].astype(np.float64) for one in passes.PORTIONS.values()]
    np.testing.assert_allclose(sum(portions), found["Combined"][..., :3], rtol=1e-4, atol=1e-5)
    assert {name for name, one in passes.PORTIONS.items() if found[one.name].max() > 1e-3} >= {
        "specular", "subsurface", "environment"}


def test_the_compositor_s_nodes_have_the_light_s_portions():
    scene = scene_of_a_sphere()
    ask_for_light()
    tree = compositor_tree(scene)
    node = tree.nodes.new("CompositorNodeRLayers")
    assert {one.name for one in passes.PORTIONS.values()} <= {socket.name for socket in node.outputs if socket.enabled}


def test_denoisers_get_albedo_and_normal(layers, tmp_path):
    scene = scene_of_two(tmp_path)
    cycles = getattr(bpy.context.view_layer, "cycles", None)
    if cycles is None:
        pytest.skip("Cycles, which keeps the setting, is not there")
    cycles.denoising_store_passes = True
    scene.camera.rotation_euler = (0.0, 0.1, 0.4)
    for material in bpy.data.materials:
        material.mesograin.model, material.mesograin.reflectance = "lambert", (0.7, 0.4, 0.1)
    found = layers()
    inside = (found[passes.OBJECT_INDEX.name][..., 0] == 3) & (found["CryptoObject00"][..., 1] == 1.0)
    assert inside.mean() > 0.1
    np.testing.assert_allclose(found["Denoising Albedo"][inside], [(0.7, 0.4, 0.1)] * inside.sum(), rtol=1e-4)
    to_camera = np.array(scene.camera.matrix_world.to_3x3().transposed())
    np.testing.assert_allclose(found["Denoising Normal"][inside], found["Normal"][inside] @ to_camera.T, atol=0.05)
    material = bpy.data.materials[0]
    material.mesograin.model = "model_3"
    translucent = layers()["Denoising Albedo"]
    assert 0.05 < translucent[SIDE // 2, SIDE // 2].max() < 1.0

# Depth, Position and Normal beside the picture: in a multi-layer file, against geometry and against Cycles.
import bpy
import numpy as np
import pytest
from mesograin import compat
from mesograin.engine import passes
from test_export import add_camera, add_sun

SIDE = 33


@pytest.fixture
def layers(native, tmp_path):
    """Renders into an EXR of many layers; {pass: (h, w, channels) float32, row 0 at the top}."""

    def do():
        scene = bpy.context.scene
        compat.ask_for_layers(scene.render.image_settings)
        scene.render.image_settings.color_depth = "32"
        scene.render.filepath = str(tmp_path / "layers.exr")
        bpy.ops.render.render(write_still=True)
        pixels, channels, _ = native.read_exr(str(tmp_path / "layers.exr"))
        found = {}
        for at, channel in enumerate(channels):
            *_, name, part = channel.split(".")
            found.setdefault(name, {})[part] = pixels[..., at]
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
    for one in passes.PASSES:
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
    for one in passes.PASSES:
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

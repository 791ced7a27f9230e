# Whole scenes by mesograin-referee as a reference: what Cycles can render it renders alike, and the rest is said.
import io
import math

import bpy
import numpy as np
import pytest
from cycles_scenes import REFEREE, depsgraph, make_sphere, place

from mesograin import compat
from mesograin.cycles import reference
from mesograin.cycles.cache import Cache
from mesograin.studies.comparison import progress, run

pytestmark = pytest.mark.skipif(not REFEREE.exists(), reason="mesograin-referee comes with the native tests")
SIZE = (24, 24)


@pytest.fixture(autouse=True)
def program(monkeypatch):
    monkeypatch.setenv("MESOGRAIN_REFEREE", str(REFEREE))


@pytest.fixture
def scene():
    """Three balls of one material on a grey ground that is no grain, under a small sun and a grey world."""
    material = make_sphere([((1.0, 1.0, 1.0), 3.0)], segments=64, rings=32, sigma_s=(0.9, 0.8, 0.5),
                           sigma_a=(0.1, 0.05, 0.02))
    bpy.data.lights["Sun"].angle = math.radians(2.0)
    first = bpy.data.objects["Sphere"]
    for number, at in enumerate(((-1.3, 0.0, 0.0), (1.3, 0.2, 0.0), (0.1, 2.2, 0.4))):
        ball = first if number == 0 else place("Ball", first.data)
        ball.location, ball.scale = at, (0.5, 0.5, 0.5)
    bpy.ops.mesh.primitive_plane_add(size=12.0, location=(0.0, 0.0, -1.3))
    ground = bpy.data.materials.new("Ground")
    compat.use_nodes(ground)
    bpy.context.object.data.materials.append(ground)
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("Sky")
    compat.use_nodes(scene.world)
    background = next(node for node in scene.world.node_tree.nodes if node.type == "BACKGROUND")
    background.inputs["Color"].default_value[:3], background.inputs["Strength"].default_value = (0.3,) * 3, 1.0
    return material


def of_grains(kind, samples):
    """(mean picture, whether pixels show grains alone)."""
    found = reference.render(depsgraph(), kind, SIZE, samples=samples, seeds=(1, 2))
    return found.mean[..., :3], found.mean[..., 3] > 0.999


def test_photons_are_what_cycles_has_for_volumes(scene):
    scene.mesograin.boundary = "index_matched"
    photons, shown = of_grains("photon_scene", 128)
    traced, also_shown = of_grains("volume_index_matched", 256)
    assert shown.sum() > 50 and np.array_equal(shown, also_shown)
    for channel in range(3):
        ratio = photons[shown][:, channel].sum() / traced[shown][:, channel].sum()
        assert ratio == pytest.approx(1.0, abs=0.02), channel


def test_a_lamp_lights_volumes_as_cycles_has_it(scene):
    """Near enough that its light fades across them; soft shadows lie on what is no grain, and do not count."""
    bpy.data.objects.remove(bpy.data.objects["Sun"])
    lamp = place("Lamp", bpy.data.lights.new("Lamp", "POINT"))
    lamp.location, lamp.data.energy, lamp.data.shadow_soft_size = (2.0, -2.0, 4.0), 1000.0, 0.3
    scene.mesograin.boundary = "index_matched"
    photons, shown = of_grains("photon_scene", 128)
    traced, _ = of_grains("volume_index_matched", 256)
    assert photons[shown].sum() == pytest.approx(traced[shown].sum(), rel=0.02)


def compare(folder, **changes):
    done = {"models": ("model_2",), "references": ("photon_scene",), "out": folder / "out", "size": SIZE, "samples": 32,
            "reference_samples": 48, "frames": 1, "cache": Cache(folder / "cache"), "command": "it"}
    return run.compare(run.Request(**{**done, **changes}), progress.Progress(io.StringIO()))["cases"][0]


def test_refracting_balls_are_compared_under_their_own_sun(scene, tmp_path):
    scene.mesograin.roughness = 0.2
    for cached in (False, True):
        case = compare(tmp_path)
        assert case["status"] == "done" and case["reference_cached"] is cached
    assert case["material"]["Sand"]["roughness"] == pytest.approx(0.2) and 50 < case["mask"]["used"] < 300
    assert case["metrics"]["bias"] == pytest.approx(1.0, abs=0.08)


# Measured 2.6, 1.9 and 2.6 percent; with walks in a ball beside what is stored for parallel light 5.0, 22 and 15.
@pytest.mark.parametrize("towards, most", [((0.4, 0.3, 1.0), 0.04), ((1.0, 0.0, 0.1), 0.04), ((-0.6, 0.2, -0.8), 0.05)])
def test_a_lamp_beside_a_refracting_grain_is_another_for_each_place(scene, tmp_path, towards, most):
    """A box of unequal channels, a radius and a half from a lamp, by transport."""
    grain = scene.mesograin
    grain.eta, grain.roughness, grain.specular = 1.4, 0.0, False
    grain.sigma_s, grain.sigma_a = (2.4, 2.0, 1.5), (0.05, 0.2, 0.5)
    for thing in list(bpy.data.objects):
        if thing.type != "CAMERA":
            bpy.data.objects.remove(thing)
    bpy.data.worlds.remove(bpy.data.worlds["Sky"])
    bpy.ops.mesh.primitive_cube_add(size=2.0, rotation=(0.3, 0.5, 0.2))
    bpy.context.object.scale = (0.9, 0.7, 0.5)
    bpy.context.object.data.materials.append(scene)
    lamp = bpy.data.lights.new("Lamp", "POINT")
    lamp.energy, lamp.shadow_soft_size, lamp.color = 100.0, 0.1, (1.0, 0.8, 0.6)
    place("Lamp", lamp).location = [2.8 * number for number in towards]
    case = compare(tmp_path, models=("transport",), reference_samples=256)
    assert case["status"] == "done", case.get("error")
    assert case["metrics"]["relative_l1_blocks"] < most


def scatter_forward_under_a_point(scene):
    scene.mesograin.g = 0.5
    bpy.data.lights["Sun"].angle = 0.0


def diffuse_what_enters(scene):
    scene.mesograin.boundary = "lambert_lambert"


@pytest.mark.parametrize("change, words", [
    (scatter_forward_under_a_point, "no path finds a sun without extent"),
    (diffuse_what_enters, "dielectric or index_matched"),
])
def test_what_photons_cannot_do_is_one_sentence(scene, tmp_path, change, words):
    change(scene)
    case = compare(tmp_path, reference_samples=1)
    assert case["status"] == "failed" and words in case["error"], case["error"]

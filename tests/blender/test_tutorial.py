# The tutorial's steps, as docs/make_tutorial.py takes them, lead where it says.
import importlib.util

import bpy
import numpy as np
import pytest

from conftest import ROOT


@pytest.fixture
def steps():
    spec = importlib.util.spec_from_file_location("make_tutorial", ROOT / "docs/make_tutorial.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def picture(render):
    def do():
        render_settings = bpy.context.scene.render
        render_settings.resolution_x, render_settings.resolution_y = 64, 36
        bpy.context.scene.mesograin.samples = 4
        return render()[..., :3]

    return do


def blocks(pixels):
    return pixels.reshape(9, 4, 16, 4, 3).mean(axis=(1, 3))


def test_a_cube_becomes_sugar(steps, picture):
    steps.begin()
    plain = picture()
    steps.make_it_sugar()
    grain = bpy.data.objects["Cube"].active_material.mesograin
    assert grain.model == "auto" and grain.boundary == "dielectric"
    sugar = picture()
    assert not np.allclose(sugar, plain, rtol=0.05)
    assert steps.choose_the_model() == "transport"

    # Its stand-in is enough to see what light does.
    grain.model = "model_2"
    steps.light_from_behind()
    behind = picture()
    middle = behind[15:21, 29:35].mean()
    assert middle > 1.5 * behind[:3, :3].mean(), "the side that no light meets is lit from within"
    steps.tweak()
    brown = picture()[15:21, 29:35].mean(axis=(0, 1))
    assert brown[0] > 1.05 * brown[1] and brown[1] > 1.05 * brown[2], "red goes farthest"


def test_sand_lights_sand(steps, picture):
    steps.begin()
    steps.pour_sand()
    alone = picture()
    steps.send_light_between_grains()
    together = picture()
    # Single pixels differ: shadows are asked for where light comes in, which is known of heaps alone, whose edges are
    # smooth from the first sample on. Measured: .982 of one block, the others above .999.
    darker = blocks(together) < 0.97 * blocks(alone)
    assert not darker.any()
    heap = alone[10:26, 20:44]
    assert together[10:26, 20:44].mean() > 1.1 * heap.mean()

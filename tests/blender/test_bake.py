# Baking an object of a scene: the right texels, the right object, sentences for what cannot be baked, whole files.
import json
import os
import pathlib
import signal
import subprocess
import time

import bpy
import numpy as np
import pytest
from cycles_scenes import depsgraph, make_sphere

from mesograin import compat
from mesograin.studies.baking import surface

COMMAND = pathlib.Path(__file__).resolve().parents[2] / "addon/mesograin/studies/baking/command.py"
SUN = [((0.0, 0.0, 1.0), np.pi)]


def bake(name=None, size=(64, 32), samples=16, margin=0, **choices):
    evaluated = depsgraph()
    chosen = surface.Surface(evaluated, surface.choose(evaluated, name), size, **choices)
    assert chosen.render(samples)
    return chosen, chosen.texture(margin)


def test_lambert_follows_the_cosine_up_the_texture():
    make_sphere(SUN, model="lambert", reflectance=(1.0, 0.5, 0.25))
    _, texture = bake()
    # A UV sphere's v is its polar angle from below, and the sun stands above.
    polar = (np.arange(32) + 0.5) / 32 * np.pi
    expected = np.maximum(np.cos(polar), 0.0)
    covered = texture[..., 3] == 1.0
    assert covered[2:-2].all()
    for channel, reflectance in enumerate((1.0, 0.5, 0.25)):
        assert np.abs(texture[2:-2, :, channel] - reflectance * expected[2:-2, None]).max() < 5e-3


def test_every_material_of_an_object_is_on_its_texture():
    bpy.ops.mesh.primitive_plane_add(size=2.0)
    plane = bpy.context.object
    bpy.ops.mesh.primitive_plane_add(size=2.0)
    other = bpy.context.object
    for uv in other.data.uv_layers[0].data:
        uv.uv = (0.5 * uv.uv[0], uv.uv[1])
    for uv in plane.data.uv_layers[0].data:
        uv.uv = (0.5 + 0.5 * uv.uv[0], uv.uv[1])
    for placed, reflectance in ((plane, 0.8), (other, 0.2)):
        material = bpy.data.materials.new("Paint")
        material.mesograin.model = "lambert"
        material.mesograin.reflectance = (reflectance,) * 3
        placed.data.materials.append(material)
    light = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    light.data.energy = np.pi
    bpy.context.scene.collection.objects.link(light)
    with bpy.context.temp_override(active_object=plane, selected_editable_objects=[plane, other]):
        bpy.ops.object.join()
    chosen, texture = bake(size=(8, 4))
    assert sorted(chosen.materials) == ["Paint", "Paint.001"]
    np.testing.assert_allclose(texture[:, :4, :3], 0.2, rtol=1e-5)
    np.testing.assert_allclose(texture[:, 4:, :3], 0.8, rtol=1e-5)


def test_the_render_uv_map_is_the_one_that_counts():
    make_sphere(SUN, model="lambert")
    layers = bpy.context.object.data.uv_layers
    half = layers.new(name="Half")
    for uv in half.data:
        uv.uv = (0.5 * uv.uv[0], uv.uv[1])
    layers[0].active = True
    half.active_render = True
    _, texture = bake()
    assert texture[10, :32, 3].all() and not texture[10, 32:, 3].any()


def test_margin_and_overlaps():
    make_sphere(SUN, model="lambert")
    for uv in bpy.context.object.data.uv_layers[0].data:
        uv.uv = (0.25 + 0.5 * uv.uv[0], 0.5 * uv.uv[1])
    chosen, texture = bake(margin=4)
    assert chosen.warnings == ()
    assert texture[24, 12:52, 3].all() and not texture[24, :12, 3].any() and not texture[24, 52:, 3].any()
    for uv in bpy.context.object.data.uv_layers[0].data:
        uv.uv = (uv.uv[0] % 0.5, uv.uv[1])
    chosen, _ = bake()
    assert len(chosen.warnings) == 1 and "UVs overlap" in chosen.warnings[0]


def test_a_bake_far_from_the_origin_is_as_exact(native):
    make_sphere(SUN, model="model_2", sigma_s=(0.9,) * 3, sigma_a=(0.1,) * 3, scale=3.0)
    _, here = bake(size=(32, 16), samples=2)
    bpy.context.object.location = (1e6, 0.0, 0.0)
    _, there = bake(size=(32, 16), samples=2)
    assert np.abs(here - there).max() < 1e-5 * here.max()


def test_the_camera_as_the_viewer():
    make_sphere(SUN, camera=(0.0, 0.0, 1e4), model="conductor", roughness=0.4, reflectance=(1.0,) * 3)
    _, above = bake(samples=4)
    _, seen = bake(samples=4, view_from="active_camera")
    # The camera looks from where the sun is: on top both see the same, halfway down they do not.
    np.testing.assert_allclose(seen[0, :, 0], above[0, :, 0], rtol=0.05)
    assert np.abs(seen[10, :, 0] / above[10, :, 0] - 1.0).min() > 0.1
    bpy.context.scene.camera = None
    with pytest.raises(surface.native_module.get().Error, match="no active camera"):
        bake(view_from="active_camera")


def test_sentences(tmp_path):
    make_sphere(SUN, model="lambert")
    sphere = bpy.context.object
    with pytest.raises(surface.BakeError, match="There is no object 'Foo' to bake.*'Sphere'"):
        bake("Foo")
    layers = sphere.data.uv_layers
    layers.remove(layers[0])
    sphere.data.update_tag()
    with pytest.raises(surface.BakeError, match="'Sphere' has no UVs to bake at: unwrap it"):
        bake()
    bright = np.full((2, 2, 4), 7e4, np.float32)
    with pytest.raises(surface.BakeError, match="65504; the largest is 70000"):
        surface.write(tmp_path / "a.exr", bright, {}, half=True)
    with pytest.raises(surface.OutputError, match="choose another place"):
        surface.require_writable(tmp_path / "nowhere" / "a.exr")
    assert not list(tmp_path.iterdir())


def test_a_cancelled_bake_stops():
    make_sphere(SUN, model="lambert")
    evaluated = depsgraph()
    chosen = surface.Surface(evaluated, "Sphere", (16, 8))
    assert not chosen.render(1 << 20, lambda fraction: chosen.cancel())
    assert chosen.samples < 1 << 20


def save_sphere(folder):
    make_sphere(SUN, model="lambert")
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "sphere.blend"))
    return folder / "sphere.blend"


def start(scene, *arguments):
    command = [bpy.app.binary_path, "--background", "--factory-startup", "--python-exit-code", "1", "--python",
               str(COMMAND), "--", str(scene), *map(str, arguments)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def test_the_command(tmp_path, native):
    scene = save_sphere(tmp_path)
    before = scene.read_bytes()
    process = start(scene, "-o", tmp_path / "a.exr", "--size", "32x16", "--samples", 4, "--set", "reflectance=0.25",
                    "--half")
    _, errors = process.communicate()
    assert process.returncode == 0, errors
    assert scene.read_bytes() == before
    pixels, channels, attributes = native.read_exr(tmp_path / "a.exr")
    assert pixels.shape == (16, 32, 4) and channels == ["R", "G", "B", "A"]
    origin = json.loads(attributes[surface.PROVENANCE])
    assert origin["object"] == "Sphere" and origin["samples"] == 4 and origin["view_from"] == "above_surface"
    assert origin["materials"]["Sand"]["reflectance"] == [0.25] * 3
    assert pixels[0, :, 0].max() == pytest.approx(0.25, rel=0.02)


def test_an_interrupted_command_leaves_nothing(tmp_path):
    scene = save_sphere(tmp_path)
    process = start(scene, "-o", tmp_path / "a.exr", "--samples", 100000)
    assert any("baking Sphere" in line for line in process.stderr), "it ended without a word of progress"
    time.sleep(0.3)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 130, errors
    assert "Interrupted: nothing was written." in errors and "Traceback" not in errors
    assert sorted(os.listdir(tmp_path)) == ["sphere.blend"]


def test_a_texture_back_on_its_object_looks_like_the_object(tmp_path, native, render):
    material = make_sphere([((1.0, 0.5, 1.0), 3.0)], segments=64, rings=32, model="lambert",
                           reflectance=(0.9, 0.5, 0.2))
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = 64
    scene.render.film_transparent = True
    scene.mesograin.samples = 16
    expected = render()
    chosen, texture = bake(size=(256, 128), samples=8, margin=4)
    surface.write(tmp_path / "a.exr", texture, chosen.provenance(4))
    compat.use_nodes(material)
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    image = nodes.new("ShaderNodeTexImage")
    image.image = bpy.data.images.load(str(tmp_path / "a.exr"))
    emission, output = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeOutputMaterial")
    links.new(image.outputs["Color"], emission.inputs["Color"])
    links.new(emission.outputs["Emission"], output.inputs["Surface"])
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.pixel_filter_type = 16, False, "BOX"
    scene.view_settings.view_transform = "Raw"
    shown = render()
    assert native.compare(shown, expected)["relative_l1"] < 0.01

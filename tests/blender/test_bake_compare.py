# Cycles' bake beside ours: the same texels, the same light, kept in the cache, nothing left behind.
import io
import json
import threading
import time

import bpy
import numpy as np
import pytest
from cycles_scenes import depsgraph, make_sphere

from mesograin.cycles import nodes, reference, unwrapping
from mesograin.cycles.cache import Cache
from mesograin.cycles.unwrapping import Unwrapping
from mesograin.studies.baking import arguments, command, comparison
from mesograin.studies.baking.surface import PROVENANCE, BakeError, Surface
from mesograin.studies.comparison.progress import Progress

SUNS = [((1.0, 1.0, 1.0), 20.0), ((-1.0, -1.0, -1.6), 10.0)]


def compare(size=(128, 64), samples=16, view_from="above_surface", model=None, kind=None, theirs=4, cache=None, **more):
    return bake(comparison.Pair(depsgraph(), "Sphere", size, samples, view_from, more, model, kind, theirs, cache))


def bake(pair):
    progress = Progress(io.StringIO())
    progress.plan(pair.steps)
    return pair.bake(progress)


def counts():
    return {name: len(getattr(bpy.data, name)) for name in ("scenes", "objects", "meshes", "materials", "images")}


def test_lambert_agrees_and_nothing_is_left_behind(tmp_path, native):
    make_sphere(SUNS, segments=64, rings=32, model="lambert", reflectance=(0.8, 0.5, 0.2))
    before = counts()
    found = compare(size=(256, 128))
    assert counts() == before
    results = found[-1]
    assert results["metrics"]["relative_l1"] < 5e-3 and abs(results["metrics"]["bias"] - 1.0) < 2e-3
    assert results["mask"]["pixels"] > 0.95 * 256 * 128 and results["notes"] == []
    comparison.write(tmp_path / "a.exr", *found)
    names = [f"a.{name}" for name in ("cycles.exr", "cycles.png", "error.exr", "error.png", "json", "mesograin.exr",
                                      "mesograin.png")]
    assert sorted(path.name for path in tmp_path.iterdir()) == names
    assert json.loads((tmp_path / "a.json").read_text()) == results
    pixels, _, attributes = native.read_exr(tmp_path / "a.cycles.exr")
    origin = json.loads(attributes[PROVENANCE])["mean_of"]
    assert [shot["object"] for shot in origin] == ["Sphere", "Sphere"] and origin[0]["view_from"] == "above_surface"
    np.testing.assert_array_equal(pixels, found[1].mean)


def test_the_command_tells_the_numbers_and_the_verdict(tmp_path, capsys, monkeypatch):
    monkeypatch.setenv("MESOGRAIN_CACHE", str(tmp_path / "cache"))
    make_sphere(SUNS, segments=64, rings=32, model="lambert")
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "grain.blend"))
    words = "--compare --size 64x32 --samples 64 --reference-samples 128 -o".split()
    chosen = arguments.parse([str(tmp_path / "grain.blend"), *words, str(tmp_path / "a.exr")])
    own = Surface(depsgraph(), "Sphere", chosen.size)
    command._compare(chosen, depsgraph(), own, {}, Progress(io.StringIO()))
    said = capsys.readouterr().out
    results = json.loads((tmp_path / "a.json").read_text())
    share = results["significance"]["share"]
    assert results["significance"]["verdict"] == "differs", "half a texel a triangle is too coarse for Cycles"
    assert f"Sphere, lambert beside Cycles Diffuse BSDF: {results['metrics']['relative_l1_corrected']:.2%} off" in said
    assert f"in {share:.1%} of the pixels" in said
    assert f"noise floor {results['noise_floor']['relative_l1']:.2%}" in said


def test_the_view_from_the_camera_is_bent_as_cycles_bends_it():
    make_sphere(SUNS, model="conductor", roughness=0.6, reflectance=(0.9,) * 3, segments=64, rings=32)
    camera = compare(size=(256, 128), view_from="active_camera")[-1]
    above = compare(size=(256, 128))[-1]
    assert camera["metrics"]["relative_l1"] < 0.02 and above["metrics"]["relative_l1"] < 0.02
    assert camera["reference"] == "glossy"


def test_the_texture_that_was_asked_for_is_not_that_of_the_comparison(tmp_path, native):
    make_sphere(SUNS, segments=64, rings=32, model="model_1", sigma_s=(8.0,) * 3, sigma_a=(2.0,) * 3)
    own = Surface(depsgraph(), "Sphere", (64, 32))
    pair = comparison.Pair(depsgraph(), "Sphere", (64, 32), 16, "above_surface", {}, None, "volume_index_matched", 1,
                           None)
    names, results = comparison.bake(tmp_path / "a.exr", own, pair, 16, 2, True, Progress(io.StringIO()))
    assert sorted(names) == sorted(path.name for path in tmp_path.iterdir())
    texture, _, attributes = native.read_exr(tmp_path / "a.exr")
    origin = json.loads(attributes[PROVENANCE])
    assert (origin["materials"]["Sand"]["boundary"], origin["margin"]) == ("dielectric", 2)
    alone = Surface(depsgraph(), "Sphere", (64, 32))
    alone.render(16)
    np.testing.assert_allclose(texture, alone.texture(2), rtol=1e-3, atol=1e-3)
    compared, _, attributes = native.read_exr(tmp_path / "a.mesograin.exr")
    assert json.loads(attributes[PROVENANCE])["materials"]["Sand"]["boundary"] == "index_matched"
    assert compared[..., :3].mean() > 1.1 * texture[..., :3].mean(), "no light is reflected inside"


def test_a_bake_by_cycles_tells_how_far_it_is_and_is_the_same_for_it(monkeypatch):
    make_sphere(SUNS, model="lambert", segments=64, rings=32)
    told = []
    sampling = reference.Sampling(depsgraph(), "diffuse", (64, 32), 37,
                                  unwrapping=Unwrapping("Sphere", "above_surface"))
    sampling.add((1,), told.append)
    assert len(told) >= 10 and told == sorted(told) and told[0] <= 0.1 and told[-1] == pytest.approx(1.0)
    monkeypatch.setattr(unwrapping, "PARTS", 1)
    whole = reference.Sampling(depsgraph(), "diffuse", (64, 32), 37, unwrapping=Unwrapping("Sphere", "above_surface"))
    whole.add((1,))
    np.testing.assert_allclose(sampling.result().mean, whole.result().mean, rtol=1e-4, atol=1e-5)


def test_no_thread_of_python_disturbs_a_bake():
    # What an operator looks up in Python while another thread runs Python crashes Blender before Python 3.12.
    make_sphere(SUNS, model="lambert", segments=16, rings=8)
    window = bpy.context.window
    shown, layer = window.scene, window.view_layer.name
    over = threading.Event()

    def busy():
        while not over.is_set():
            time.sleep(0.0)

    threads = [threading.Thread(target=busy) for _ in range(4)]
    for thread in threads:
        thread.start()
    try:
        assert all(compare(size=(16, 8), samples=1, theirs=1)[1].mean[..., 3].any() for _ in range(60))
    finally:
        over.set()
        for thread in threads:
            thread.join()
    assert window.scene == shown and window.view_layer.name == layer


def test_a_thick_translucent_grain_agrees_with_the_subsurface_node():
    make_sphere([((0.0, 0.0, 1.0), np.pi)], model="model_1", sigma_s=(0.8,) * 3, sigma_a=(0.2,) * 3, scale=50.0,
                segments=64, rings=32)
    results = compare(size=(64, 32), kind="subsurface", theirs=32)[-1]
    if not nodes.features().subsurface_refracts:
        assert {values["boundary"] for values in results["material"].values()} == {"lambert_lambert"}
    assert abs(results["metrics"]["bias"] - 1.0) < 0.05
    assert results["metrics"]["relative_l1"] < 2.0 * results["noise_floor"]["relative_l1"] + 0.05


def test_texels_that_cycles_does_not_bake_are_not_compared():
    make_sphere(SUNS, model="lambert", segments=64, rings=32)
    for uv in bpy.context.object.data.uv_layers[0].data:
        uv.uv = (0.5 * uv.uv[0], 0.5 + 0.5 * uv.uv[1])
    _, theirs, mask, results = compare()
    assert theirs.mean[:30, :62, 3].min() == 1.0 and theirs.mean[34:, :, 3].max() == 0.0
    assert not mask[32:].any() and not mask[:, 64:].any() and mask[2:30, 2:62].all()
    assert results["metrics"]["relative_l1"] < 0.02


def test_bakes_are_kept_by_what_determines_them(tmp_path):
    make_sphere(SUNS, model="lambert", segments=32, rings=16)
    cache = Cache(tmp_path)
    assert not compare(size=(16, 8), theirs=1, cache=cache)[1].cached
    assert compare(size=(16, 8), theirs=1, cache=cache)[1].cached
    assert not compare(size=(16, 8), theirs=1, cache=cache, view_from="active_camera")[1].cached
    bpy.context.object.data.uv_layers[0].data[0].uv[0] += 0.01
    assert not compare(size=(16, 8), theirs=1, cache=cache)[1].cached
    # A picture of the camera is no texture.
    assert not reference.render(depsgraph(), "diffuse", (16, 8), samples=1, cache=cache).cached


def test_sentences():
    material = make_sphere(SUNS, model="model_1", g=-0.5, sigma_s=(0.9,) * 3, sigma_a=(0.1,) * 3)
    with pytest.raises(reference.ReferenceError, match="'Sand'.*allows g between 0"):
        compare(kind="subsurface")
    with pytest.raises(BakeError, match="The reference glossy does not answer model_1"):
        compare(kind="glossy")
    material.mesograin.model = "lambert"
    with pytest.raises(BakeError, match="There is no object 'Foo'"):
        comparison.Pair(depsgraph(), "Foo", (8, 8), 1, "above_surface", {}, None, None, 1, None)
    with pytest.raises(reference.ReferenceError, match="no object 'Foo' to bake with Cycles"):
        reference.Sampling(depsgraph(), "diffuse", (8, 8), 1, unwrapping=Unwrapping("Foo", "above_surface")).add((1,))
    coarse = compare(size=(8, 4), theirs=1)[-1]
    assert len(coarse["notes"]) == 1 and "one triangle alone" in coarse["notes"][0]

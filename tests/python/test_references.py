"""The models against pictures of the same scenes that other renderers made: pbrt-v4 and a photon Monte Carlo."""

import json
import pathlib

import mesograin_native as native
import pytest

FOLDER = pathlib.Path(__file__).resolve().parents[1] / "data/reference"
MANIFEST = json.loads((FOLDER / "manifest.json").read_text())

# Largest relative L1. Of the 2.5 % of model_1 about 1.7 % is the sphere's curvature, which a BRDF does not know and
# model_2 does.
LIMITS = {"lambert": 0.005, "conductor": 0.002, "model_1": 0.025, "model_2": 0.016, "model_3": 0.016}
# Light that shines through, from in front and from behind: diffusion is least sure of it, a BRDF knows nothing of it.
TRANSLUCENT = {"mc_H_e1.3_s6_A.exr": {"model_2": 0.023, "model_3": 0.02},
               "mc_H_e1.3_s1_A.exr": {"model_2": 0.05, "model_3": 0.047},
               "mc_H_e1.0_s1_K.exr": {"model_2": 0.13, "model_3": 0.115}}
MODELS = {"diffuse": ["lambert"], "conductor": ["conductor"], "smooth_mc": ["model_1", "model_2", "model_3"]}
SAMPLES = {"lambert": 16, "model_3": 8}


def limits_of(entry):
    return TRANSLUCENT.get(entry["file"]) or {model: LIMITS[model] for model in MODELS[entry["material"]["kind"]]}


CASES = [(entry, model, limit) for entry in MANIFEST["images"] for model, limit in limits_of(entry).items()]


def render(source, model, samples):
    scene, camera, size = native.load_scene(source, model=model)
    view = native.View(*size)
    view.set_scene(scene)
    view.set_camera(camera)
    view.render(samples)
    return view.read()


@pytest.mark.parametrize(("entry", "model", "limit"), CASES, ids=[f"{case[0]['file']}-{case[1]}" for case in CASES])
def test_reference(entry, model, limit):
    """An entry merged with the manifest's geometry and camera is a scene as it stands."""
    image = render({**MANIFEST, **entry}, model, samples=SAMPLES.get(model, 64))
    reference, _, _ = native.read_exr(FOLDER / entry["file"])
    result = native.compare(image, reference, mask=native.default_mask(image[..., 3]))
    assert result["mask"]["nan"] == result["mask"]["inf"] == 0
    assert result["mask"]["pixels"] > 0.6 * image.shape[0] * image.shape[1]
    assert result["relative_l1"] < limit
    assert not native.take_gl_errors()

"""Pictures of grains against photon Monte Carlo, in blocks of 8x8 pixels: no worse than what was measured."""
import pathlib
import sys

import mesograin_native as native
import pytest

TESTS = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TESTS / "bench"))
import shape_pictures  # noqa: E402
import shapes  # noqa: E402

# Relative L1, model 2 and model 3.
BARS = {
    "cube_e1.3_R3_front_a.9.exr R": (0.22, 0.165), "cube_e1.3_R3_side_a.9.exr R": (0.21, 0.155),
    "cube_e1.3_R3_back_a.9.exr R": (0.33, 0.215),
    "sphere_e1.3_R3_back.exr G": (0.065, 0.045), "sphere_e1.3_R3_back.exr B": (0.045, 0.035),
    "sphere_e1.3_R10_back.exr G": (0.09, 0.075), "sphere_e1.3_R10_back.exr B": (0.065, 0.065),
}
GRAINS = shapes.Shapes(native, TESTS / "data/shapes")


# A cube of radii 1.5, 3 and 6 mean free paths: relative L1 of `transport` in red, green and blue.
COLOURED = shapes.Shapes(native, TESTS / "data/coloured_shapes")
COLOURED_BARS = {"cube_e1.3_R3_coloured_front.exr": (0.055, 0.04, 0.04),
                 "cube_e1.3_R3_coloured_back.exr": (0.06, 0.045, 0.085)}


@pytest.mark.parametrize("image", COLOURED.images, ids=lambda image: f"{image['file']} {image['channel']}")
def test_a_thick_channel_is_as_sharp_as_it_is_alone(image):
    channel = "RGB".index(image["channel"])
    drawn = COLOURED.draw(image, "transport", 64, 8)[..., channel]
    assert shapes.compare(drawn, COLOURED.truth(image))["relative_l1"] < COLOURED_BARS[image["file"]][channel]


# Media that scatter forwards, a cube of radius 3 and a sphere of radius 1: relative L1 of `transport`, noise of 48
# frames included; as small as the truth, where each scattering looks for unscattered light, and twice as large, where
# it is found beforehand.
FORWARDS = shapes.Shapes(native, TESTS / "data/forward_shapes")
FORWARDS_BARS = {"cube_e1.3_R3_g0.85_front.exr": (0.14, 0.08), "cube_e1.3_R3_g0.85_side.exr": (0.11, 0.1),
                 "cube_e1.3_R3_g0.85_back.exr": (0.1, 0.09), "sphere_e1.3_R1_g0.95_front.exr": (0.16, 0.11),
                 "sphere_e1.3_R1_g0.95_side.exr": (0.2, 0.12), "sphere_e1.3_R1_g0.85_back.exr": (0.05, 0.045)}


# An irregular grain of radius 1, g 0.85: how far off it may be.
SAND_BAR = 0.1


@pytest.mark.parametrize("image", [image for image in FORWARDS.images if image["mesh"] == "sand"],
                         ids=lambda image: image["file"])
def test_sand_that_scatters_forwards_is_lit_by_all_that_its_surface_reflects(image, tmp_path):
    made = {**image, "mesh": str(tmp_path / shape_pictures.write_mesh("sand", tmp_path))}
    figures = shapes.compare(FORWARDS.draw(made, "transport", samples=48)[..., 0], FORWARDS.truth(image))
    assert figures["relative_l1"] < SAND_BAR
    assert figures["total"] == pytest.approx(1.0, abs=0.05)


@pytest.mark.parametrize("times", [1, 2])
@pytest.mark.parametrize("image", [image for image in FORWARDS.images if image["mesh"] != "sand"],
                         ids=lambda image: image["file"])
def test_light_that_scatters_forwards_is_as_photons_say(image, times):
    width, height = image["resolution"]
    larger = {**image, "resolution": [times * width, times * height]}
    drawn = FORWARDS.draw(larger, "transport", samples=48)[..., 0]
    drawn = drawn.reshape(height, times, width, times).mean(axis=(1, 3))
    figures = shapes.compare(drawn, FORWARDS.truth(image))
    assert figures["relative_l1"] < FORWARDS_BARS[image["file"]][times - 1]
    assert figures["total"] == pytest.approx(1.0, abs=0.12)


# A cube whose surface is rough, GGX alpha 0.5: with light that is smooth inside it was 5 to 12 % off.
ROUGH = shapes.Shapes(native, TESTS / "data/rough_shapes")
ROUGH_BAR = 0.04


@pytest.mark.parametrize("image", ROUGH.images, ids=lambda image: image["file"])
def test_a_rough_surface_is_rough_from_inside_too(image):
    figures = shapes.compare(ROUGH.draw(image, "transport", samples=24)[..., 0], ROUGH.truth(image))
    assert figures["relative_l1"] < ROUGH_BAR
    assert figures["total"] == pytest.approx(1.0, abs=0.04)


# A sphere of radius 10 from behind, where next to nothing arrives: at albedo 0.9 it was 0.77 off, at 0.999 0.17, while
# light went too far between nodes and was lost on its way to the viewer, and 0.35 and 0.06 while a few functions of the
# light's direction told of a sun.
DARK_BARS = {0.9: 0.1, 0.999: 0.07}


@pytest.mark.parametrize("image", [image for image in GRAINS.images if image["file"] == "sphere_e1.3_R10_back.exr"],
                         ids=lambda image: image["channel"])
def test_the_dark_side_of_a_thick_grain_is_as_dark(image):
    drawn = GRAINS.draw(image, "transport", samples=4)[..., "RGB".index(image["channel"])]
    assert shapes.compare(drawn, GRAINS.truth(image))["relative_l1"] < DARK_BARS[round(shapes.albedo(image), 6)]


# Grains that are not convex. Two balls grown together, from behind, each gather the sun in a spot: 0.16 off while a few
# functions of the light's direction told of it. A ring of radius 10 was 0.054 off while light that left it and entered
# it again was scattered there as if it came from outside; where nothing refracts, ring and balls 0.046 and 0.086, while
# sunlight was not followed through all of them.
HOLLOWED = shapes.Shapes(native, TESTS / "data/hollowed_shapes")
HOLLOWED_BARS = {"peanut_e1.3_R1_back.exr": 0.05, "torus_e1.3_R10_front.exr": 0.03, "torus_e1_R3_side.exr": 0.02,
                 "peanut_e1_R3_back.exr": 0.03}


@pytest.mark.parametrize("image", HOLLOWED.images, ids=lambda image: f"{image['file']} {image['channel']}")
def test_light_finds_its_way_through_what_is_not_convex(image, tmp_path):
    made = {**image, "mesh": str(tmp_path / shape_pictures.write_mesh(image["mesh"], tmp_path))}
    drawn = HOLLOWED.draw(made, "transport", samples=4)[..., "RGB".index(image["channel"])]
    assert shapes.compare(drawn, HOLLOWED.truth(image))["relative_l1"] < HOLLOWED_BARS[image["file"]]


# A curved grain of radius 10 from the front: its total was .973 of the truth's while nodes beyond the surface, between
# which and those below it view rays pass, were stored as it is at the surface's nearest point.
THICK = shapes.Shapes(native, TESTS / "data/thick_shapes")
THICK_BAR = 0.015


@pytest.mark.parametrize("image", THICK.images, ids=lambda image: image["file"])
def test_the_lit_side_of_a_thick_curved_grain_is_as_bright(image, tmp_path):
    made = {**image, "mesh": str(tmp_path / shape_pictures.write_mesh("sand", tmp_path))}
    drawn = THICK.draw(made, "transport", samples=4)[..., 0]
    assert shapes.compare(drawn, THICK.truth(image))["total"] == pytest.approx(1.0, abs=THICK_BAR)


@pytest.mark.parametrize("image", GRAINS.images, ids=lambda image: f"{image['file']} {image.get('channel', 'R')}")
@pytest.mark.parametrize("model", ["model_2", "model_3"])
def test_a_picture_is_that_of_the_photons(image, model):
    bar = BARS[f"{image['file']} {image.get('channel', 'R')}"][model == "model_3"]
    drawn = GRAINS.draw(image, model, 64, 8)[..., 0]
    assert shapes.compare(drawn, GRAINS.truth(image))["relative_l1"] < bar

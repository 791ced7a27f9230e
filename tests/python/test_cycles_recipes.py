"""What Cycles is told, worked out without Blender: recipes, limits, kinds."""

import pytest
from addon_rooms import room

grain_values = room("cycles.grain_values")
kinds = room("cycles.kinds")
limits = room("cycles.limits")
recipes = room("cycles.recipes")

BLENDER_3 = kinds.NodeFeatures("ShaderNodeBsdfGlossy", "separable", "RANDOM_WALK_FIXED_RADIUS", False, "SHARP", False,
                               False)
BLENDER_4 = kinds.NodeFeatures("ShaderNodeBsdfAnisotropic", "correlated", "RANDOM_WALK", True, "GGX", True, True)


def grain(**parameters):
    return grain_values.GrainValues(**parameters)


def inputs(kind, values, node, features=BLENDER_3):
    return recipes.recipe(kind, values, features)["nodes"][node]["inputs"]


def test_scale_multiplies_both_coefficients():
    values = grain_values.GrainValues.from_parameters(
        {
            "reflectance": (0.5,) * 3,
            "sigma_a": (0.1,) * 3,
            "sigma_s": (0.9,) * 3,
            "g": 0.0,
            "eta": 1.3,
            "roughness": 0.2,
            "scale": 20.0,
            "model": "model_1",
        }
    )
    assert values.sigma_a == pytest.approx((2.0,) * 3)
    assert values.sigma_s == pytest.approx((18.0,) * 3)
    assert values.albedo == pytest.approx((0.9,) * 3)


def test_glossy_takes_the_root_of_alpha():
    assert inputs("glossy", grain(roughness=0.25), "Glossy")["Roughness"] == pytest.approx(0.5)
    assert (
        recipes.recipe("glossy", grain(roughness=0.25), BLENDER_4)["nodes"]["Glossy"]["type"]
        == "ShaderNodeBsdfAnisotropic"
    )


@pytest.mark.parametrize(
    "sigma_a, sigma_s",
    [
        ((0.1, 0.2, 0.9), (0.9, 0.1, 0.0)),
        ((0.0,) * 3, (5.0, 1e-6, 2.0)),
        ((3.0,) * 3, (0.0,) * 3),
        ((1e-9, 1e9, 1.0), (1e9, 1.0, 1e-9)),
    ],
)
def test_volume_nodes_carry_the_coefficients(sigma_a, sigma_s):
    values = grain(sigma_a=sigma_a, sigma_s=sigma_s, g=-0.3)
    scatter, absorption = (inputs("volume_index_matched", values, name) for name in ("Scatter", "Absorption"))
    assert [scatter["Density"] * c for c in scatter["Color"]] == pytest.approx(sigma_s, rel=1e-12)
    # 1 - colour cannot resolve a channel sixteen orders under the brightest.
    assert [absorption["Density"] * (1.0 - c) for c in absorption["Color"]] == pytest.approx(
        sigma_a, rel=1e-12, abs=1e-15 * max(sigma_a)
    )
    assert scatter["Anisotropy"] == -0.3


def test_subsurface_sockets():
    sockets = inputs("subsurface", grain(sigma_a=(0.1,) * 3, sigma_s=(0.9,) * 3), "Subsurface")
    assert sockets["Color"] == pytest.approx((0.47334,) * 3, abs=1e-5)
    assert sockets["Radius"] == pytest.approx((12.566371,) * 3)
    assert (sockets["Scale"], sockets["Anisotropy"], sockets["IOR"]) == (1.0, 0.0, 1.3)


def test_glass_is_sharp_and_holds_the_medium():
    values = grain(sigma_a=(0.1, 0.2, 0.3), sigma_s=(0.9, 0.5, 0.1), eta=1.45, roughness=0.2)
    glass = recipes.recipe("volume_dielectric", values, BLENDER_4)
    assert glass["nodes"]["Glass"]["inputs"] == {"Color": (1.0, 1.0, 1.0), "Roughness": 0.0, "IOR": 1.45}
    bare = recipes.recipe("volume_index_matched", values, BLENDER_4)
    assert all(glass["nodes"][name] == bare["nodes"][name] for name in ("Scatter", "Absorption"))
    assert ["Glass", "BSDF", "Output", "Surface"] in glass["links"]


def test_the_medium_between_lambert_surfaces_is_that_of_the_others():
    values = grain(sigma_a=(0.1, 0.2, 0.3), sigma_s=(0.9, 0.5, 0.1), eta=1.45)
    between = recipes.recipe("volume_lambert", values, BLENDER_4)
    assert between["nodes"]["Entry"]["inputs"] == {"Color": (1.0, 1.0, 1.0)}
    bare = recipes.recipe("volume_index_matched", values, BLENDER_4)
    assert all(between["nodes"][name] == bare["nodes"][name] for name in ("Scatter", "Absorption"))
    assert ["Entry", "BSDF", "Output", "Surface"] in between["links"]


def test_burley_takes_the_reduced_medium():
    # sigma_s (1 - g) = 0.9: the same as without g.
    skewed = inputs("subsurface_burley", grain(sigma_a=(0.1,) * 3, sigma_s=(1.8,) * 3, g=0.5), "Subsurface")
    plain = inputs("subsurface_burley", grain(sigma_a=(0.1,) * 3, sigma_s=(0.9,) * 3), "Subsurface")
    assert skewed["Color"] == pytest.approx(plain["Color"])
    assert plain["Color"] == pytest.approx((0.47334,) * 3, abs=1e-5)
    assert skewed["Radius"] == pytest.approx((12.566371,) * 3)


@pytest.mark.parametrize("kind", ["subsurface", "subsurface_burley"])
def test_what_the_node_is_to_others_has_its_colour(kind):
    medium = {"reflectance": (0.5,) * 3, "sigma_a": (0.1, 0.2, 0.3), "sigma_s": (1.0, 2.0, 0.5), "scale": 2.0, "g": 0.4,
              "eta": 1.4, "roughness": 0.1}
    ours = kinds.of_material({"model": "model_2", **kinds.our_side(kind, BLENDER_3)}, medium)
    node = recipes.recipe(kind, grain_values.GrainValues.from_parameters(medium), BLENDER_3)["nodes"]["Subsurface"]
    assert ours == {"model": "model_2", "boundary": "lambert_lambert", "reflectance_to_others": node["inputs"]["Color"]}
    assert 0.1 < min(ours["reflectance_to_others"]) < max(ours["reflectance_to_others"]) < 0.7


def test_subsurface_takes_alpha_itself():
    node = recipes.recipe("subsurface", grain(roughness=0.25), BLENDER_4)["nodes"]["Subsurface"]
    assert node["optional"]["Roughness"] == 0.25


def test_our_side_solves_what_cycles_solves():
    assert kinds.our_side("subsurface", BLENDER_3)["boundary"] == "lambert_lambert"
    assert kinds.our_side("subsurface", BLENDER_4)["boundary"] == "lambert_refracted"
    assert kinds.our_side("subsurface_burley", BLENDER_4)["boundary"] == "lambert_lambert"
    assert kinds.our_side("volume_index_matched", BLENDER_4) == {"boundary": "index_matched"}
    assert kinds.our_side("volume_lambert", BLENDER_4) == {"boundary": "lambert_lambert"}
    for kind in ("volume_dielectric", "photon"):
        assert kinds.our_side(kind, BLENDER_3) == {"boundary": "dielectric", "roughness": 0.0, "specular": False}
    assert kinds.our_side("photon_scene", BLENDER_3) == {}
    assert kinds.our_side("glossy", BLENDER_3) == {"masking": "separable"}
    assert kinds.our_side("glossy", BLENDER_4) == {"masking": "correlated"}
    assert [kinds.default_kind(model) for model in ("lambert", "conductor", "model_3")] == [
        "diffuse",
        "glossy",
        "volume_index_matched",
    ]


@pytest.mark.parametrize(
    "kind, parameters, words, fatal",
    [
        ("subsurface", {"g": -0.2}, "g between 0 and 0.9", True),
        ("subsurface", {"g": 0.95}, "g between 0 and 0.9", True),
        ("subsurface", {"sigma_a": (0.0, 1.0, 1.0), "sigma_s": (0.0, 1.0, 1.0)}, "positive", True),
        ("subsurface", {"eta": 4.0}, "1.01 to 3.8", False),
        ("subsurface", {"sigma_a": (1e-3,) * 3, "sigma_s": (1.0,) * 3}, "256 bounces", False),
        ("volume_index_matched", {"sigma_a": (0.0,) * 3, "sigma_s": (0.0,) * 3}, "invisible", True),
        ("volume_index_matched", {"g": 1.0}, "0.999", False),
        ("volume_index_matched", {"sigma_a": (1e-5,) * 3, "sigma_s": (1.0,) * 3}, "1024 bounces", False),
        ("volume_lambert", {"sigma_a": (0.0,) * 3, "sigma_s": (0.0,) * 3}, "invisible", True),
        ("volume_dielectric", {"roughness": 0.3}, "left out on both sides", False),
        ("photon", {"g": 1.0}, "g inside (-1, 1)", True),
        ("photon_scene", {"g": -1.0}, "g inside (-1, 1)", True),
        ("subsurface_burley", {"g": -0.4}, "similarity", False),
        ("subsurface_burley", {"sigma_a": (0.0, 1.0, 1.0), "sigma_s": (0.0, 1.0, 1.0)}, "positive", True),
        ("glossy", {"roughness": 0.0}, "mirror", True),
    ],
)
def test_limits_are_said(kind, parameters, words, fatal):
    found = limits.limits(grain(**parameters), kind)
    assert [limit.fatal for limit in found] == [fatal]
    assert words in found[0].sentence and found[0].sentence.endswith(".")


def test_ordinary_grains_have_no_limits():
    for kind in kinds.KINDS:
        roughness = 0.0 if kind in ("volume_dielectric", "photon") else 0.3
        assert limits.limits(grain(roughness=roughness), kind) == []

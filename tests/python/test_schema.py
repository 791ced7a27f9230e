"""The schema of a grain's parameters and models, and that all who take from it agree."""
import itertools
import subprocess
import sys

import mesograin_native as native
import pytest
from addon_rooms import room
from conftest import SOURCE

schema = room("schema")
MODELS = room("schema.models").MODELS
PARAMETERS = room("schema.parameters").PARAMETERS
NUMBERS = [parameter for parameter in PARAMETERS.values() if parameter.kind in ("number", "rgb")]


def test_the_native_module_was_built_with_this_schema():
    assert native.schema() == schema.GRAIN


def test_scenes_are_said_alike_on_both_sides():
    exchange = room("schema.parameters").SCENE["exchange"]
    assert native.Scene().exchange == exchange.default
    for choice in exchange.choices:
        assert native.Scene(exchange=choice.name).exchange == choice.name
    with pytest.raises(native.Error, match=", ".join(choice.name for choice in exchange.choices)):
        native.Scene(exchange="somehow")


def test_defaults_are_the_native_module_s():
    standard = native.Material()
    for name, parameter in PARAMETERS.items():
        value = getattr(standard, name)
        assert (tuple(value) if parameter.kind == "rgb" else value) == parameter.default


@pytest.mark.parametrize("parameter", NUMBERS, ids=lambda parameter: parameter.name)
def test_ranges_hold_on_both_sides(parameter):
    def given(number):
        return {parameter.name: (number,) * 3 if parameter.kind == "rgb" else number}

    for allowed in (parameter.least, parameter.most, parameter.default):
        assert parameter.check(allowed) is not None
    native.Material(**given(parameter.least))
    native.Material(**given(parameter.most))
    step = 1e-3 * (parameter.most - parameter.least)
    for wrong in (parameter.least - step, parameter.most + step, float("nan"), float("inf")):
        assert parameter.check(wrong) is None
        with pytest.raises(native.Error, match=parameter.name):
            native.Material(**given(wrong))


def test_a_parameter_takes_what_it_says():
    rgb, number = PARAMETERS["sigma_a"], PARAMETERS["g"]
    assert rgb.check(2) == (2.0,) * 3 and rgb.check([1, 2, 3]) == (1.0, 2.0, 3.0)
    assert rgb.check([1, 2]) is None and rgb.check([1, 2, True]) is None and rgb.check("1") is None
    assert number.check(0.5) == 0.5 and number.check(True) is None and number.check([0.5]) is None
    assert PARAMETERS["specular"].check(False) is False and PARAMETERS["specular"].check(0) is None
    assert PARAMETERS["profile"].check("dipole") == "dipole" and PARAMETERS["profile"].check("exact") is None


@pytest.mark.parametrize("given, part", [
    ({"sigma": 1.0}, "A material takes model, reflectance, .*; got 'sigma'."),
    ({"g": "high"}, "g must be a number; got 'high'."),
    ({"sigma_a": (1.0, 2.0)}, r"sigma_a must be three numbers; got \(1.0, 2.0\)."),
    ({"profile": "exact"}, "profile must be one of half_space, better_dipole, dipole, photon_beam; got 'exact'."),
    ({"specular": "yes"}, "specular must be True or False; got 'yes'."),
])
def test_a_material_says_what_it_takes(given, part):
    with pytest.raises(native.Error, match=part):
        native.Material(**given)


@pytest.mark.parametrize("model", MODELS.values(), ids=lambda model: model.name)
def test_a_model_has_its_shader_and_its_inputs(model):
    assert (SOURCE / f"shaders/models/{model.name}.glsl").is_file()
    assert (SOURCE / f"native/models/{model.name}_inputs.cpp").is_file()
    assert set(model.parameters) <= set(PARAMETERS)
    assert set(model.profiles) <= {choice.name for choice in PARAMETERS["profile"].choices}


def test_each_kind_has_one_preferred_model_or_one_at_all():
    for kind in set(itertools.chain.from_iterable(model.kinds for model in MODELS.values())):
        answering = [model for model in MODELS.values() if kind in model.kinds]
        assert len(answering) == 1 or sum(model.preferred for model in answering) == 1


def test_a_profile_that_a_model_does_not_know_is_named():
    view = native.View(8, 8)
    mesh = native.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], None, [[0, 1, 2]])
    for model in MODELS.values():
        for choice in PARAMETERS["profile"].choices:
            if model.profiles and choice.name not in model.profiles:
                material = native.Material(model=model.name, profile=choice.name)
                with pytest.raises(native.Error, match=f"profile for {model.name} must be one of .*'{choice.name}'"):
                    view.set_scene(native.Scene(instances=[native.Instance(mesh, material)], lights=[]))


def test_the_models_are_listed_nowhere_else():
    for folder in ("addon", "native", ".launcher"):
        for path in (SOURCE / folder).rglob("*"):
            if path.suffix in (".py", ".sh", ".cpp", ".h", ".j2", ".js"):
                text = path.read_text()
                listed = [name for name in MODELS if f"{name}," in text.replace("'", "").replace('"', "")]
                assert len(listed) < 3, f"{path} lists {', '.join(listed)}"


def test_the_docs_page_is_the_schema_s():
    page = subprocess.run([sys.executable, SOURCE / "docs/make_parameters.py"], capture_output=True, text=True,
                          check=True).stdout
    assert (SOURCE / "docs/parameters.md").read_text() == page, "python3 docs/make_parameters.py > docs/parameters.md"

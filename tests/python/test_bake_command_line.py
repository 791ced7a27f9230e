"""The command line of `bake`: what it takes, and one sentence for what it does not."""

import subprocess

import pytest
from addon_rooms import room
from conftest import BUILD, SOURCE

import mesograin_native as native

arguments = room("studies.baking.arguments")
choices = room("studies.baking.choices")


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "a.blend"
    path.write_bytes(b"")
    return str(path)


def test_defaults(scene):
    chosen = arguments.parse([scene, "-o", "a.exr"])
    assert chosen.size == (1024, 1024) and chosen.view_from == "above_surface" and chosen.margin == 16
    assert chosen.settings == {} and not chosen.half


def test_choices(scene):
    chosen = arguments.parse([scene, "-o", "A.EXR", "--size", "640x480", "--set", "g=0.5", "--set", "sigma_a=1,2,3"])
    assert chosen.size == (640, 480) and chosen.settings == {"g": 0.5, "sigma_a": (1.0, 2.0, 3.0)}
    assert arguments.parse([scene, "-o", "a.exr", "--size", "77"]).size == (77, 77)


@pytest.mark.parametrize("words, sentence", [
    (["-o", "a.png"], "must end in .exr, 'a.png' came"),
    (["-o", "a.exr", "--size", "0"], "1 to 16384 texels is needed, '0' came"),
    (["-o", "a.exr", "--size", "16385x4"], "'16385x4' came"),
    (["-o", "a.exr", "--size", "nan"], "'nan' came"),
    (["-o", "a.exr", "--margin", "-1"], "0 to 32767 is needed, '-1' came"),
    (["-o", "a.exr", "--samples", "0"], "a whole number from 1"),
    (["-o", "a.exr", "--view-from", "below"], "invalid choice: 'below'"),
    ([], "-o/--output"),
])
def test_what_is_wrong_is_one_sentence(scene, capsys, words, sentence):
    with pytest.raises(SystemExit) as left:
        arguments.parse([scene, *words])
    said = capsys.readouterr().err
    assert left.value.code == 2 and sentence in said and said.startswith("bake: ") and said.count("\n") == 1


def test_a_scene_that_is_not_there(capsys):
    with pytest.raises(SystemExit):
        arguments.parse(["nowhere.blend", "-o", "a.exr"])
    assert "there is no scene 'nowhere.blend'" in capsys.readouterr().err


def test_the_tool_bakes_what_the_module_bakes(tmp_path):
    tool = BUILD / "native/tool/mesograin-render"
    sphere = SOURCE / "tests/data/sphere.json"
    command = [tool, sphere, "--bake", "--size", "24", "-n", "3", "--margin", "2", "-o", tmp_path / "a.exr"]
    outcome = subprocess.run(list(map(str, command)), capture_output=True, text=True)
    assert outcome.returncode == 0, outcome.stderr
    pixels, _, attributes = native.read_exr(tmp_path / "a.exr")
    assert attributes["mesograin:view_from"] == "above_surface" and attributes["mesograin:margin"] == "2"
    assert "v up" in attributes["mesograin:uv"]
    scene, camera, _ = native.load_scene(str(sphere))
    view = native.View(24, 24)
    view.set_scene(scene)
    view.set_camera(camera)
    for view_from in choices.VIEW_FROM:
        view.set_bake([0], view_from)
    view.set_bake([0])
    assert view.uv_use() == {"texels": 576, "overlapping": 0, "triangles_outside": 0, "warnings": []}
    view.render(3)
    assert (native.extend_margin(view.read(), 2) == pixels).all()


def test_meshes_say_whether_they_have_uvs():
    corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    assert not native.Mesh(corners, None, [[0, 1, 2]]).has_uvs
    bare = native.Scene(instances=[native.Instance(native.Mesh(corners, None, [[0, 1, 2]]), native.Material())])
    view = native.View(4, 4)
    view.set_scene(bare)
    with pytest.raises(native.Error, match="has none: unwrap it"):
        view.set_bake([0])


@pytest.mark.parametrize("words, sentence", [
    (["--reference", "diffuse"], "need --compare"),
    (["--compare", "--reference", "paint"], "invalid choice: 'paint'"),
])
def test_what_a_comparison_takes(scene, capsys, words, sentence):
    with pytest.raises(SystemExit):
        arguments.parse([scene, "-o", "a.exr", *words])
    assert sentence in capsys.readouterr().err
    chosen = arguments.parse([scene, "-o", "a.exr", "--compare", "--half"])
    assert (chosen.margin, chosen.half) == (16, True), "a comparison beside it changes nothing of the texture"

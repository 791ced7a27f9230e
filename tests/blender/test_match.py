# A match in Blender's scene: which pixels and which material count, units, pictures in codes, the button's result.
import json

import bpy
import numpy as np
import pytest
from cycles_scenes import depsgraph, make_sphere, place

from mesograin.cycles import reference
from mesograin.grains import objects
from mesograin.studies.comparison.progress import Calls
from mesograin.studies.match import choices, of_blender, run, subject, target
from mesograin.ui.match_panel import operators, properties
from mesograin.ui.match_panel.session import MatchError, session
from mesograin.ui.side_task import pictures

SUNS = [((1.0, 1.0, 2.0), 3.0)]
SIGMA_S, SIGMA_A = (1.5, 2.0, 2.5), (0.05, 0.1, 0.4)
UNKNOWN = (1.0, 1.0, 1.0)


@pytest.fixture
def grain():
    """A sphere's material, drawn by a fast model."""
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = 64
    scene.mesograin.samples = 16
    return make_sphere(SUNS, segments=64, rings=32, model="model_2", sigma_s=SIGMA_S, sigma_a=SIGMA_A, specular=False)


def forget(grain):
    grain.mesograin.sigma_s = grain.mesograin.sigma_a = UNKNOWN


def matched(tmp_path, whole, **asked):
    quiet = Calls(lambda _: None, lambda _: None)
    return run.match(choices.Asked(tmp_path / "match", samples=8, **asked), whole, quiet, "")


def add_ground():
    """A plane of another material behind the sphere, over the whole picture."""
    mesh = bpy.data.meshes.new("Ground")
    mesh.from_pydata([(-9, -9, -3), (9, -9, -3), (9, 9, -3), (-9, 9, -3)], [], [(0, 1, 2, 3)])
    mesh.materials.append(bpy.data.materials.new("Ground"))
    mesh.materials[0].mesograin.reflectance = (0.3, 0.5, 0.2)
    place("Ground", mesh)


def test_the_coefficients_of_a_render(grain, render, tmp_path, native):
    add_ground()
    # What the ground sends to a lone grain is told by random rays, which are others for other coefficients.
    bpy.context.scene.mesograin.exchange = "off"
    bpy.context.scene.mesograin.millimetres_per_unit = 0.5
    whole = target.linear("F12", render())
    forget(grain)
    found = matched(tmp_path, whole)
    assert found["unit"] == "1/mm" and found["material"] == "Sand" and found["complete"]
    assert found["sigma_s"] == pytest.approx(SIGMA_S, rel=0.03)
    assert found["sigma_a"] == pytest.approx(SIGMA_A, rel=0.03)
    for name, truth in (("sigma_s", SIGMA_S), ("sigma_a", SIGMA_A)):
        assert all(entry["low"] <= true <= entry["high"] for entry, true in zip(found["intervals"][name], truth))
    assert 500 < found["metrics"]["mask"]["pixels"] < 3000  # the ground is in the picture and does not count
    assert tuple(grain.mesograin.sigma_s) == UNKNOWN
    written = json.loads((tmp_path / "match/match.json").read_text())
    assert written == found
    assert native.read_exr(tmp_path / "match/model.exr")[0].shape == (64, 64, 4)
    beside = bpy.data.images.load(str(tmp_path / "match/beside.png"))
    assert tuple(beside.size) == (128, 64)


@pytest.mark.parametrize("shape", ["sphere", "sand"])
def test_the_coefficients_of_a_render_by_cycles(tmp_path, shape):
    """Of an index-matched volume, a radius of three mean free paths; model 2 alone is off by a fifth."""
    size = bpy.context.scene.render.resolution_x = bpy.context.scene.render.resolution_y = 48
    sigma_s, sigma_a = (1.2, 1.0, 0.6), (0.15, 0.2, 0.6)
    grain = make_sphere([((1.0, 1.0, 1.0), 20.0), ((-1.0, -1.0, -1.6), 10.0)], segments=64, rings=32, model="model_2",
                        sigma_s=sigma_s, sigma_a=sigma_a)
    if shape == "sand":
        bpy.context.object.data = objects.mesh("sand", size=2.4, seed=3, segments=20)
        bpy.context.object.data.materials.append(grain)
    traced = reference.render(depsgraph(), "volume_index_matched", (size, size), samples=64, seeds=(1,)).mean
    forget(grain)
    found = matched(tmp_path, target.linear("Cycles", traced), reference="volume_index_matched", corrections=3,
                    traced_samples=64)
    assert found["sigma_s"] == pytest.approx(sigma_s, rel=0.1)
    assert found["sigma_a"] == pytest.approx(sigma_a, rel=0.1)
    assert 1 <= found["corrections"] <= 3
    assert found["corrected_blocks"] < 0.5 * found["metrics"]["relative_l1_blocks"]


def test_a_photograph_of_unknown_brightness(grain, render, tmp_path):
    pixels = render()[..., :3]
    brightness = 0.8 / pixels.max()
    codes = np.clip(pixels * brightness, 0.0, 1.0)
    codes = np.where(codes <= 0.0031308, 12.92 * codes, 1.055 * codes ** (1.0 / 2.4) - 0.055)
    photograph = bpy.data.images.new("Photograph", 64, 64)
    photograph.pixels.foreach_set(np.dstack((codes[::-1], np.ones((64, 64)))).astype(np.float32).ravel())
    photograph.file_format, photograph.filepath_raw = "PNG", str(tmp_path / "photograph.png")
    photograph.save()
    grain.mesograin.sigma_a = UNKNOWN
    found = matched(tmp_path, of_blender.load(tmp_path / "photograph.png"), parameters=("sigma_a",), exposure="free")
    assert found["sigma_a"] == pytest.approx(SIGMA_A, rel=0.1)
    assert found["exposure"] == pytest.approx(brightness, rel=0.05)


def test_an_image_of_the_file(tmp_path, native):
    bright = np.random.default_rng(3).uniform(0.0, 9.0, (20, 30, 4)).astype(np.float32)
    bright[..., 3] = 1.0
    native.write_exr(tmp_path / "bright.exr", bright)
    image = bpy.data.images.load(str(tmp_path / "bright.exr"))
    assert of_blender.target(image).pixels == pytest.approx(bright[..., :3])
    image.colorspace_settings.name = "Non-Color"
    image.pack()
    assert of_blender.target(image).pixels == pytest.approx(bright[..., :3])
    mask = of_blender.mask(tmp_path / "bright.exr", (30, 20))
    assert mask.shape == (20, 30) and mask.mean() > 0.9


class TestErrors:
    def whole(self, height=64):
        return target.linear("picture", np.ones((height, 64, 3), np.float32))

    @pytest.mark.parametrize("change, asked, sentence", [
        (lambda grain: None, {"material": "Salt"}, "no translucent grain of the material 'Salt'; it shows Sand"),
        (lambda grain: setattr(grain.mesograin, "model", "lambert"), {}, "shows no translucent grain"),
        (lambda grain: setattr(bpy.context.scene.render, "resolution_y", 32), {}, "give the scene the picture's prop"),
        (lambda grain: bpy.context.object.data.materials.append(_other()), {}, "several grains' materials.*Salt, Sand"),
        (lambda grain: setattr(bpy.context.scene.camera, "location", (0.0, 0.0, -6.5)), {}, "camera sees no grain"),
    ])
    def test_a_scene_without_an_answer(self, grain, tmp_path, change, asked, sentence):
        change(grain)
        depsgraph()
        with pytest.raises(subject.SubjectError, match=sentence):
            matched(tmp_path, self.whole(), **asked)

    def test_cycles_corrects_one_material_alone(self, grain, tmp_path):
        add_ground()
        depsgraph()
        with pytest.raises(subject.SubjectError, match="all is of one material; the scene shows Ground, Sand"):
            matched(tmp_path, self.whole(), reference="volume_index_matched", corrections=1)

    def test_an_image_without_an_answer(self, tmp_path):
        (tmp_path / "no.png").write_text("no picture")
        with pytest.raises(target.TargetError, match="no.png"):
            of_blender.load(tmp_path / "no.png")
        with pytest.raises(target.TargetError, match="There is no picture"):
            of_blender.load(tmp_path / "none.png")
        filmic = bpy.data.images.new("Filmic", 32, 32)
        filmic.colorspace_settings.name = "Filmic sRGB" if "Filmic sRGB" in _spaces(filmic) else "AgX Base sRGB"
        with pytest.raises(target.TargetError, match="colour space"):
            of_blender.target(filmic)

    def test_the_button_says_what_is_missing(self, grain):
        with bpy.context.temp_override(material=grain):
            with pytest.raises(MatchError, match="No picture is chosen"):
                session.launch(bpy.context)
            bpy.context.scene.mesograin_match.image = bpy.data.images.new("Picture", 64, 64)
            bpy.context.scene.mesograin_match.parameters = set()
            with pytest.raises(MatchError, match="Nothing is searched for"):
                session.launch(bpy.context)


def _spaces(image):
    return [item.identifier for item in image.colorspace_settings.bl_rna.properties["name"].enum_items]


def _other():
    """A second grain's material, on some of the faces."""
    other = bpy.data.materials.new("Salt")
    other.mesograin.model = "model_2"
    for face in bpy.context.object.data.polygons[:100]:
        face.material_index = 1
    return other


def test_the_result_is_applied(grain):
    grain.mesograin.scale = 20.0
    assert not operators.MESOGRAIN_OT_apply_match.poll(bpy.context)
    session.results = {"material": "Sand", "sigma_a": (0.1, 0.2, 0.3), "sigma_s": (4.0, 5.0, 6.0), "g": 0.5,
                       "scale": 1.0}
    try:
        assert bpy.ops.mesograin.apply_match() == {"FINISHED"}
    finally:
        session.forget()
    made = grain.mesograin
    assert tuple(made.sigma_a) == pytest.approx((0.1, 0.2, 0.3)) and tuple(made.sigma_s) == (4.0, 5.0, 6.0)
    assert (made.g, made.scale) == (0.5, 1.0)
    assert "UNDO" in operators.MESOGRAIN_OT_apply_match.bl_options


def test_one_undo_takes_an_applied_result_back(grain):
    names = ("sigma_a", "sigma_s", "g", "scale")

    def values():
        made = bpy.data.materials["Sand"].mesograin
        return [list(value) if hasattr(value := getattr(made, name), "__len__") else [value] for name in names]

    grain.mesograin.scale, grain.mesograin.g = 20.0, -0.25
    bpy.ops.ed.undo_push(message="before")
    before = values()
    session.results = {"material": "Sand", "sigma_a": (0.25, 0.5, 0.75), "sigma_s": (4.0, 5.0, 6.0), "g": 0.5,
                       "scale": 1.0}
    try:
        assert bpy.ops.mesograin.apply_match("EXEC_DEFAULT", True) == {"FINISHED"}
        after = [[0.25, 0.5, 0.75], [4.0, 5.0, 6.0], [0.5], [1.0]]
        assert values() == after
        bpy.ops.ed.undo()
        assert values() == before
        bpy.ops.ed.redo()
        assert values() == after
        assert operators.MESOGRAIN_OT_apply_match.poll(bpy.context), "the result is there to be applied again"
    finally:
        session.forget()


def test_a_result_is_not_applied_to_a_linked_material(grain, tmp_path):
    library = str(tmp_path / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=library)
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    with bpy.data.libraries.load(library, link=True) as (_, here):
        here.materials = ["Sand"]
    linked = here.materials[0]
    before = tuple(linked.mesograin.sigma_a)
    session.results = {"material": "Sand", "sigma_a": (0.25, 0.5, 0.75), "sigma_s": (4.0, 5.0, 6.0), "g": 0.5,
                       "scale": 1.0}
    try:
        with pytest.raises(RuntimeError, match="'Sand' is linked"):
            bpy.ops.mesograin.apply_match()
    finally:
        session.forget()
    assert tuple(linked.mesograin.sigma_a) == before


def test_the_panel_asks_for_what_the_study_takes(grain, tmp_path):
    asked = bpy.context.scene.mesograin_match
    asked.image = bpy.data.images.new("Picture", 64, 64)
    arguments = properties.arguments(bpy.context.scene)
    assert arguments.pop("image") == "Picture"
    assert choices.Asked(tmp_path, **arguments).settings() == {**choices.Asked(tmp_path).settings(),
                                                               "parameters": ["sigma_a", "sigma_s"]}
    asked.reference, asked.free_exposure = "volume_index_matched", True
    assert properties.arguments(bpy.context.scene)["reference"] == "volume_index_matched"
    assert properties.arguments(bpy.context.scene)["exposure"] == "free"


def test_what_was_matched_is_not_called_cycles():
    """It may be a photograph."""
    session.results = {"material": "Sand", "files": {"model": "model.exr", "reference": "target.exr",
                                                     "error": "error.exr"}}
    try:
        shown = pictures.pictures_of(session.entry)
        assert {operators.BUTTONS[name][0] for name in shown} == {"Model", "Picture", "Error"}
    finally:
        session.forget()

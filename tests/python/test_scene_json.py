"""Scenes in JSON as Python sees them: paths, text and dicts; the native tests hold every key and every mistake."""

import json
import pathlib

import mesograin_native as native
import numpy as np
import pytest

SPHERE = pathlib.Path(__file__).resolve().parents[1] / "data/sphere.json"


def test_path_text_and_dict_are_one_scene():
    text = SPHERE.read_text()
    for source in (SPHERE, str(SPHERE), text, json.loads(text)):
        scene, camera, size = native.load_scene(source)
        assert size == (400, 400)
        assert len(scene.instances) == 1 and len(scene.lights) == 2
        assert scene.instances[0].material.model == "lambert"
        assert scene.instances[0].material.reflectance == [0.8, 0.6, 0.4]
        assert scene.lights[1].irradiance == [10, 10, 10]
        expected = native.Camera.look_at((0, 0, 6.5), (0, 0, 0), (0, 1, 0), 45.0)
        np.testing.assert_array_equal(camera.world_to_camera, expected.world_to_camera)


def test_model_and_size_are_the_callers():
    scene = json.loads(SPHERE.read_text())
    scene["material"] = {"kind": "subsurface", "sigma_s": 1, "sigma_a": 0.1}
    loaded, _, size = native.load_scene(scene, model="model_2", size=(40, 30))
    assert loaded.instances[0].material.model == "model_2"
    assert size == (40, 30)


@pytest.mark.parametrize("change, part", [
    ({"material": {"kind": "diffuse", "reflectance": float("nan")}}, "which has no NaN"),
    ({"material": {"kind": "diffuse", "reflectance": -1}}, "material.reflectance must lie between 0 and 1; got -1"),
    ({"lights": []}, "lights must be a list of at least one light"),
    ({"colour": 1}, "colour is an unknown key"),
    ({"geometry": {"shape": "mesh", "file": "none.obj"}}, "There is no file none.obj"),
])
def test_mistakes_raise_one_sentence(change, part):
    with pytest.raises(native.Error, match=r"\.$") as raised:
        native.load_scene({**json.loads(SPHERE.read_text()), **change})
    assert part in str(raised.value)


def test_unknown_files_models_and_sizes_are_named():
    for arguments, part in [
        (("none.json",), "There is no file none.json"),
        ((SPHERE, "model_9"), "got 'model_9'"),
        ((SPHERE, "conductor"), "which lambert answers; got the model conductor"),
        ((SPHERE, None, (0, 5)), "1 to 16384 pixels a side; got 0 x 5"),
    ]:
        with pytest.raises(native.Error) as raised:
            native.load_scene(*arguments)
        assert part in str(raised.value)


def test_a_scene_that_is_written_is_the_one_that_is_read(tmp_path):
    random = np.random.default_rng(3)
    mesh = native.Mesh(np.float32([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]), None,
                       np.uint32([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]), np.float32(random.random((4, 2))))
    sand = native.Material(model="model_2", sigma_s=(1, 2, 3), sigma_a=(0.1, 0.2, 0.3), eta=1.5, roughness=0.2)
    ground = native.Material(model="lambert", reflectance=(0.5, 0.4, 0.3))
    transforms = np.eye(4) + 0.1 * random.random((20, 4, 4)) * [[1], [1], [1], [0]]
    lights = [native.DirectionalLight((1, 1, 1), (3, 2, 1), 0.01, flat=True),
              native.PointLight((1, 2, 3), (4, 5, 6), 0.1),
              native.SpotLight((1, 2, 3), (0, 0, -1), (4, 5, 6), angle=0.5, blend=0.25),
              native.AreaLight((0, 0, 5), (1, 0, 0), (0, 2, 0), (7, 8, 9), ellipse=True)]
    backdrop = native.Backdrop((1, 0.5, 0.2), native.Surroundings(np.float32(random.random((2, 4, 3)))),
                               np.float64([[0, 0, 1], [1, 0, 0], [0, 1, 0]]))
    world = native.World(radiance=(0.5, 0.25, 1), image=native.Surroundings(np.float32(random.random((4, 8, 3)))),
                         rotation=np.float64([[0, 1, 0], [-1, 0, 0], [0, 0, 1]]), seen=True, backdrop=backdrop)
    scene = native.Scene(instances=[native.Instance(mesh, ground, transforms[0])], lights=lights, world=world,
                         arrays=[native.InstanceArray(mesh, sand, transforms)], exchange="order_1")
    camera = native.Camera.look_at((0, -5, 2), (0, 0, 0), (0, 0, 1), 40.0, 1.5)

    native.write_scene(tmp_path / "heap.json", scene, camera, (48, 32))
    read, read_camera, size = native.load_scene(tmp_path / "heap.json")
    assert size == (48, 32) and read_camera == camera
    np.testing.assert_array_equal(read.arrays[0].transforms, transforms)
    assert read.exchange == "order_1" and native.Scene().exchange == "heaps"
    assert read.arrays[0].material == sand and read.instances[0].material == ground
    assert [type(light) for light in read.lights] == [type(light) for light in lights]
    assert read.lights[0].flat and not native.DirectionalLight((1, 1, 1), (3, 2, 1)).flat

    pictures = []
    for each in (scene, read):
        view = native.View(*size)
        view.set_scene(each)
        view.set_camera(camera)
        view.render(4)
        pictures.append(view.read())
    assert pictures[0].max() > 0.1
    np.testing.assert_array_equal(*pictures)


def test_light_between_grains_is_one_of_its_names():
    described = {**json.loads(pathlib.Path(SPHERE).read_text()), "exchange": "order_9"}
    with pytest.raises(native.Error, match="exchange.*off, heaps, order_1"):
        native.load_scene(described)
    read, *_ = native.load_scene({**described, "exchange": "off"})
    assert read.exchange == "off"


def test_a_scene_is_not_written_where_it_cannot_be(tmp_path):
    scene, camera, size = native.load_scene(SPHERE)
    with pytest.raises(native.Error, match=r"\.$"):
        native.write_scene(tmp_path / "none" / "heap.json", scene, camera, size)


@pytest.mark.parametrize("diffuse", [{"retro_reflective": True}, {"diffuse_roughness": 0.7}])
def test_a_finish_is_written_and_read(tmp_path, diffuse):
    """Byte pictures as sRGB, by UV and by place, wrapped in every way; the numbers beside them."""
    random = np.random.default_rng(5)
    mesh = native.Mesh(np.float32([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]), None,
                       np.uint32([[0, 1, 2], [0, 2, 3]]), np.float32([[0, 0], [2, 0], [2, 2], [0, 2]]))
    coloured = native.Picture(random.integers(0, 256, (6, 9, 4), dtype=np.uint8), srgb=True)
    grey = native.Picture(np.repeat(np.float32(random.random((4, 4, 1))), 4, axis=2))
    finish = native.Finish(
        reflectance=native.TextureMap(coloured, wrap="mirror"), metallic=native.TextureMap(grey, wrap="extend"),
        roughness=native.TextureMap(grey, by_position=True, wrap="clip",
                                    to_picture=[[0.4, 0.1, 0, 0.2], [0, 0.7, 0, 0]]),
        emission=native.TextureMap(coloured, smooth=False), normal=native.TextureMap(coloured), normal_strength=0.5,
        coat=0.05, coat_roughness=0.4, **diffuse, metal_whitens=True, facets_keep_energy=True,
        facets_shade_bumps=True, bent_normals_stay=True, faces_are_lights=True, radiance=(0.5, 0.4, 0.3))
    material = native.Material(model="lambert", reflectance=(0.5, 0.4, 0.3), finish=finish)
    scene = native.Scene(instances=[native.Instance(mesh, material)],
                         lights=[native.DirectionalLight((0.3, 0.2, 1), (3, 2, 1))])
    camera = native.Camera.look_at((0, -1, 4), (0, 0, 0), (0, 1, 0), 30.0)
    native.write_scene(tmp_path / "tile.json", scene, camera, (32, 32))
    read, _, size = native.load_scene(tmp_path / "tile.json")

    pictures = []
    for each in (scene, read):
        view = native.View(*size)
        view.set_scene(each)
        view.set_camera(camera)
        view.render(4)
        pictures.append(view.read())
    assert pictures[0][..., :3].std() > 0.05
    # A device may interpolate bytes in bytes, which are numbers once they were read.
    assert np.abs(pictures[0] - pictures[1]).sum() < 0.01 * pictures[0].sum()


@pytest.mark.parametrize("finish, part", [
    ({"coat": 2}, "coat must lie between 0 and 1"), ({"coats": 1}, "coats is an unknown key"),
    ({"reflectance_map": {"image": "none.exr"}}, "none.exr"),
    ({"normal_map": {"image": "none.exr", "by": "luck"}}, "none.exr")])
def test_a_finish_that_makes_no_sense_is_said(finish, part):
    scene = json.loads(SPHERE.read_text())
    scene["material"] = {"kind": "diffuse", "reflectance": 0.5, "finish": finish}
    with pytest.raises(native.Error, match=part):
        native.load_scene(scene)

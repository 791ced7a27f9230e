# Placings of arrays from Python: scenes share them, and two are equal by content.
import mesograin_native as native
import numpy as np
import pytest


@pytest.fixture
def places():
    matrices = np.tile(np.eye(4, dtype=np.float32), (5, 1, 1))
    matrices[:, :3, 3] = np.random.default_rng(3).normal(size=(5, 3))
    return matrices


def test_they_come_back_as_they_were_given(places):
    transforms = native.Transforms(places)
    assert len(transforms) == 5 and transforms.matrices().dtype == np.float32
    np.testing.assert_array_equal(transforms.matrices(), places)
    third = places.astype(np.float64) / [1.0, 1.0, 3.0, 1.0]
    np.testing.assert_array_equal(native.Transforms(third).matrices(), third)


def test_content_makes_them_equal(places):
    transforms = native.Transforms(places)
    assert transforms == native.Transforms(places.astype(np.float64)) and transforms == transforms
    assert transforms != native.Transforms(places[:4]) and transforms != "placings"
    places[4, 0, 3] += 1.0
    assert transforms != native.Transforms(places)


def test_an_array_takes_them_as_it_takes_numbers(places):
    mesh = native.Mesh(np.eye(3, dtype=np.float32), np.eye(3, dtype=np.float32), np.array([[0, 1, 2]], dtype=np.uint32))
    material = native.Material(model="lambert")
    for transforms in (places, native.Transforms(places)):
        np.testing.assert_array_equal(native.InstanceArray(mesh, material, transforms).transforms, places)
    with pytest.raises(TypeError):
        native.InstanceArray(mesh, material, None)


@pytest.mark.parametrize("shape", [(4, 4), (3, 3, 4), (2, 4, 3)])
def test_other_shapes_are_refused(shape):
    with pytest.raises(native.Error, match=r"\(n, 4, 4\)"):
        native.Transforms(np.zeros(shape))


# Where tables depend on the size of a grain, instances lie sorted by it.
@pytest.mark.parametrize("model", ["lambert", "model_2"])
def test_each_instance_of_arrays_is_put_where_it_is_at_another_moment(model):
    corners = np.float32([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)])
    mesh = native.Mesh(corners, None, np.uint32([(0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2)]))
    material = native.Material(model=model, sigma_a=(0.1,) * 3, sigma_s=(3.0,) * 3)
    places = np.tile(np.diag([0.3, 0.3, 0.3, 1.0]), (18, 1, 1))
    places[:, :3, :3] *= np.resize((1.0, 2.0), 18)[:, None, None]
    places[:, :2, 3] = np.stack(np.divmod(np.arange(18), 5), axis=-1) - 2.0
    moved = places.copy()
    moved[:, 2, 3] = 0.2 * np.arange(18)
    camera = native.Camera.look_at((0.0, -3.0, 9.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 45.0)

    def scene(*arrays):
        return native.Scene(arrays=[native.InstanceArray(mesh, material, array) for array in arrays], exchange="off",
                            lights=[native.DirectionalLight((0.3, 0.2, 1.0), (3.0,) * 3)])

    aside = places + np.array([[0, 0, 0, 3.0], [0] * 4, [0] * 4, [0] * 4])
    pictures = []
    for begins in ((places, aside), (moved, aside)):
        view = native.View(48, 48)
        view.set_visibility("cast")
        view.set_scene(scene(*begins))
        view.set_camera(camera)
        view.set_moment(camera, scene(moved, aside))
        view.render(1)
        pictures.append(view.read())
    assert pictures[0].max() > 0.1
    # Places are told from another anchor: the last bit may move an edge across a pixel's middle.
    assert (np.abs(pictures[0] - pictures[1]).max(axis=-1) > 1e-4).mean() < 0.005

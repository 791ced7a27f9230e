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

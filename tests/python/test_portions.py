"""What a picture's light is made of: together the portions are the picture, whatever is drawn and however."""
import itertools

import mesograin_native as native
import numpy
import pytest

SIZE = 32
LIGHT = ("diffuse", "specular", "subsurface", "single_scattering", "transmission", "exchange", "emission",
         "environment")
MEDIUM = {"sigma_s": (2.0, 2.5, 3.0), "sigma_a": (0.05, 0.1, 0.3), "scale": 1.0}


def ball():
    """A closed one: the octahedron's faces, each cut in four three times."""
    corners = [[(x, 0, 0), (0, y, 0), (0, 0, z)][::x * y * z] for x, y, z in itertools.product((-1, 1), repeat=3)]
    faces = numpy.array(corners, dtype=numpy.float64)
    for _ in range(3):
        a, b, c = (faces[:, corner] for corner in range(3))
        ab, bc, ca = a + b, b + c, c + a
        faces = numpy.concatenate([numpy.stack(face, axis=1) for face in
                                   ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
        faces /= numpy.linalg.norm(faces, axis=-1, keepdims=True)
    places, triangles = numpy.unique(faces.reshape(-1, 3).round(6), axis=0, return_inverse=True)
    places = places.astype(numpy.float32)
    return native.Mesh(places, places, triangles.reshape(-1, 3).astype(numpy.uint32))


BALL = ball()


def place(x, y, z, scale=1.0):
    matrix = numpy.diag([scale, scale, scale, 1.0])
    matrix[:3, 3] = x, y, z
    return matrix


def told(material, count=1, visibility="automatic", exchange="heaps", **more):
    """({portion: (h, w, 3)}, the picture (h, w, 4)) of a ball, or of many, under a sun, a lamp and a sky."""
    instances, arrays = [], []
    if count == 1:
        instances.append(native.Instance(BALL, material, place(0.0, 0.0, 0.0)))
    else:
        places = [place(0.9 * (number % 4) - 1.4, 0.9 * (number // 4) - 0.6, 0.0, 0.4) for number in range(count)]
        arrays.append(native.InstanceArray(BALL, material, numpy.array(places)))
    scene = native.Scene(
        instances=instances, arrays=arrays, exchange=exchange,
        lights=[native.DirectionalLight((0.5, 1.0, 0.7), (3.0, 2.5, 2.0)),
                native.PointLight((-2.0, 1.0, 3.0), (6.0, 6.0, 9.0), radius=0.2)],
        world=native.World(radiance=(0.3, 0.4, 0.6), seen=True), **more)
    view = native.View(SIZE, SIZE)
    view.set_visibility(visibility)
    view.set_scene(scene)
    view.set_camera(native.Camera.look_at((0.0, 0.4, 5.0), (0.0, -0.3, 0.0), (0.0, 1.0, 0.0), 50.0))
    view.render(2)
    before = view.read()
    view.set_portions([*LIGHT, "normal"])
    view.render(2)
    picture = view.read()
    numpy.testing.assert_array_equal(picture, before)
    return {name: view.read_portion(name)[..., :3] for name in (*LIGHT, "normal")}, picture


def expect_sum(portions, picture):
    total = sum(portions[name].astype(numpy.float64) for name in LIGHT)
    assert picture[..., :3].max() > 0.2
    numpy.testing.assert_allclose(total, picture[..., :3], rtol=1e-4, atol=2e-6)


MODELS = {
    "lambert": (native.Material(model="lambert"), {"diffuse"}),
    "conductor": (native.Material(model="conductor", roughness=0.3), {"specular"}),
    "coat": (native.Material(model="lambert", roughness=0.3, finish=native.Finish(coat=0.04, radiance=(0.1, 0.2, 0.0))),
             {"diffuse", "specular", "emission"}),
    "model_1": (native.Material(model="model_1", boundary="dielectric", roughness=0.2, g=0.4, **MEDIUM),
                {"specular", "subsurface", "single_scattering"}),
    "model_2": (native.Material(model="model_2", boundary="dielectric", roughness=0.2, g=0.4, **MEDIUM),
                {"specular", "subsurface", "single_scattering", "transmission"}),
    "model_3": (native.Material(model="model_3", boundary="dielectric", roughness=0.2, g=0.4, **MEDIUM),
                {"specular", "subsurface", "single_scattering", "transmission"}),
    "transport": (native.Material(model="transport", boundary="dielectric", roughness=0.2, sigma_s=(0.3, 0.4, 0.5),
                                  sigma_a=(0.05, 0.1, 0.3)), {"specular", "subsurface", "transmission"}),
}


@pytest.mark.parametrize("name", MODELS)
def test_of_one_grain_they_are_the_picture(name):
    material, expected = MODELS[name]
    portions, picture = told(material)
    expect_sum(portions, picture)
    middle = slice(SIZE // 2 - 8, SIZE // 2 - 2), slice(SIZE // 2 - 3, SIZE // 2 + 3)
    found = {each for each in LIGHT if portions[each][middle].max() > 1e-4}
    assert found == expected
    assert numpy.allclose(portions["environment"][0, 0], (0.3, 0.4, 0.6), atol=1e-6)
    lengths = numpy.linalg.norm(portions["normal"], axis=-1)
    assert lengths[middle].min() > 0.95 and lengths.max() < 1.0 + 1e-5 and lengths[0, 0] == 0.0


@pytest.mark.parametrize("visibility", ["drawn", "cast"])
@pytest.mark.parametrize("name", ["lambert", "model_2"])
def test_of_a_heap_they_are_the_picture(name, visibility):
    portions, picture = told(MODELS[name][0], count=12, visibility=visibility)
    expect_sum(portions, picture)
    assert portions["exchange"].max() > 1e-3


def test_of_gathered_light_they_are_the_picture():
    portions, picture = told(MODELS["lambert"][0], count=12, visibility="cast", exchange="gathered")
    expect_sum(portions, picture)


def test_of_light_that_is_followed_they_are_the_picture():
    """Without a surface that refracts a grain of a heap asks no model."""
    material = native.Material(model="model_2", boundary="index_matched", **MEDIUM)
    portions, picture = told(material, count=12, visibility="cast")
    expect_sum(portions, picture)
    found = {name for name in LIGHT if portions[name].max() > 1e-2}
    assert found == {"subsurface", "transmission", "exchange", "environment"}
    lengths = numpy.linalg.norm(portions["normal"], axis=-1)
    assert 0.95 < lengths.max() < 1.0 + 1e-5


def test_what_was_not_asked_for_is_not_told():
    view = native.View(8, 8)
    with pytest.raises(native.Error, match="'specular' is not told"):
        view.read_portion("specular")
    with pytest.raises(native.Error, match="must be one of diffuse, .*got 'glossy'"):
        view.set_portions(["glossy"])

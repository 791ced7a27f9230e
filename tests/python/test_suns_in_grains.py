"""What each sun does in a single grain of `transport` is found by itself; in arrays, and where there are many, a few
functions of the direction tell it of all."""

import mesograin_native as native
import numpy
import pytest

from test_transport_colours import sphere

TO_SUN = (-0.3, 0.4, -0.8660254)  # from behind
CAMERA = native.Camera.look_at((0.0, 0.0, 6.5), (0.0,) * 3, (0.0, 1.0, 0.0), 45.0)
GREY = {"sigma_s": (3.0,) * 3, "sigma_a": (0.33,) * 3}


def medium(**changed):
    return native.Material(**{"model": "transport", "boundary": "dielectric", "specular": False, **GREY, **changed})


def turned(angle, squeezed=0.6):
    """An ellipsoid's transform."""
    matrix = numpy.diag((1.0, squeezed, 1.0, 1.0))
    turn = numpy.eye(4)
    turn[:2, :2] = [[numpy.cos(angle), -numpy.sin(angle)], [numpy.sin(angle), numpy.cos(angle)]]
    return turn @ matrix


def sun(to_sun=TO_SUN, irradiance=(1.0,) * 3, angle=0.0):
    return native.DirectionalLight(to_sun, irradiance, angle=angle)


def scene(transforms=(turned(0.3),), lights=(sun(),), material=None, array=False):
    grain = material or medium()
    if array:
        arrays = [native.InstanceArray(sphere(48, 24), grain, numpy.array(transforms))]
        return native.Scene(arrays=arrays, lights=list(lights), exchange="off")
    instances = [native.Instance(sphere(48, 24), grain, transform) for transform in transforms]
    return native.Scene(instances=instances, lights=list(lights), exchange="off")


def picture(shown, samples=4, size=64):
    view = native.View(size, size)
    view.set_scene(shown)
    view.set_camera(CAMERA)
    view.render(samples)
    return view.read()[..., :3]


def apart(image, other):
    return float(numpy.abs(image - other).sum() / other.sum())


def beside(transforms, count):
    """As many beyond the picture."""
    far = numpy.array(transforms[0])
    return [*transforms, *(far + [[0.0] * 3 + [60.0 + i], *[[0.0] * 4] * 3] for i in range(count))]


def test_where_there_are_many_all_are_told_as_those_of_an_array():
    single = picture(scene())
    of_many = picture(scene(beside([turned(0.3)], 16)))
    of_array = picture(scene(beside([turned(0.3)], 16), array=True))
    assert apart(of_many, of_array) < 0.01
    assert 0.01 < apart(single, of_array) < 0.1, "what few functions of the direction leave out"


def test_up_to_sixteen_are_found():
    assert apart(picture(scene(beside([turned(0.3)], 15))), picture(scene())) < 1e-5


@pytest.mark.parametrize("changed", [{}, {"sigma_a": (0.1, 0.33, 1.0)}, {"boundary": "index_matched"},
                                     {"boundary": "index_matched", "sigma_a": (0.1, 0.33, 1.0)}],
                         ids=["grey", "coloured", "matched", "matched and coloured"])
def test_two_suns_are_the_sum_of_them(changed):
    material = medium(**changed)
    red, blue = sun(irradiance=(1.0, 0.5, 0.1)), sun((0.8, 0.6, 0.0), (0.1, 0.2, 1.0))
    together = picture(scene(lights=(red, blue), material=material))
    one_by_one = sum(picture(scene(lights=(each,), material=material)) for each in (red, blue))
    assert apart(together, one_by_one) < 1e-4


def test_a_sun_that_does_not_shine_and_a_lamp_beside_it_change_no_other():
    dark, lamp = sun((0.0, 1.0, 0.0), (0.0,) * 3), native.PointLight((0.0, 0.0, 4.0), (9.0,) * 3)
    by_sun, by_lamp = picture(scene()), picture(scene(lights=(lamp,)))
    assert apart(picture(scene(lights=(dark, sun(), lamp))), by_sun + by_lamp) < 0.01


def test_a_wide_sun_is_all_of_its_disc():
    many = picture(scene(lights=(sun(angle=0.5),)))
    narrow = []
    for azimuth in numpy.arange(8) * numpy.pi / 4:
        towards = numpy.array(TO_SUN) / numpy.linalg.norm(TO_SUN)
        across = numpy.cross(towards, (0.0, 1.0, 0.0))
        across /= numpy.linalg.norm(across)
        ring = numpy.cos(azimuth) * across + numpy.sin(azimuth) * numpy.cross(towards, across)
        # Half of a disc's area lies within its radius over the root of two.
        narrow.append(picture(scene(lights=(sun(tuple(towards + numpy.tan(0.25) / numpy.sqrt(2.0) * ring)),))))
    assert apart(many, numpy.mean(narrow, axis=0)) < 0.02


def test_a_grain_that_spins_while_it_is_exposed_is_lit_where_it_turns_to():
    view = native.View(64, 64)
    view.set_scene(scene())
    view.set_camera(CAMERA)
    view.set_moment(CAMERA, scene([turned(1.6)]))
    view.render(4)
    moment = view.read()[..., :3]
    settled = picture(scene([turned(1.6)]))
    assert apart(moment, settled) < 0.1
    assert apart(picture(scene()), settled) > 0.3

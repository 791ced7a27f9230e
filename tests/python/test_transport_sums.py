"""What is stored for `transport` is summed once for each sun, or for all together where nothing stands in their way;
where lamps shine, at each pixel: the same picture."""

import mesograin_native as native
import numpy
import pytest

from test_transport_colours import sphere
from test_transport_energy import cube

SUNS = (((0.5, 0.5, 0.7), (1.0, 0.8, 0.6)), ((-0.4, 0.3, -0.85), (0.5, 1.0, 0.2)))
TURN = numpy.array([[0.6, -0.8, 0.0, 0.1], [0.8, 0.6, 0.0, -0.05], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]])
COLOURS = pytest.mark.parametrize("sigma_a", [(0.3, 0.3, 0.3), (0.1, 0.5, 1.5)], ids=["grey", "coloured"])


def draw(view, material, suns=SUNS, lamps=(), others=(), samples=4):
    """(64, 64, 3)."""
    lights = [native.DirectionalLight(to_light, irradiance) for to_light, irradiance in suns]
    view.set_scene(native.Scene(instances=[native.Instance(sphere(48, 24), material, TURN), *others],
                                lights=lights + list(lamps)))
    view.set_camera(native.Camera.look_at((0.0, 0.0, 6.5), (0.0,) * 3, (0.0, 1.0, 0.0), 22.0))
    view.render(samples)
    return view.read()[..., :3]


def picture(material, **shown):
    return draw(native.View(64, 64), material, **shown)


def medium(boundary, sigma_a, **changed):
    return native.Material(model="transport", boundary=boundary, specular=False, sigma_a=sigma_a,
                           **{"sigma_s": (3.0,) * 3, **changed})


def blocks(image):
    return image.reshape(8, 8, 8, 8).mean(axis=(1, 3))


@pytest.mark.parametrize("boundary", ["index_matched", "dielectric"])
@COLOURS
def test_a_lamp_too_faint_to_see_changes_nothing(boundary, sigma_a):
    material = medium(boundary, sigma_a)
    faint = native.PointLight((0.0, 0.0, 1000.0), (1e-9,) * 3)
    summed, anew = picture(material), picture(material, lamps=[faint])
    assert summed.max() > 0.1
    numpy.testing.assert_allclose(summed, anew, atol=2e-3 * summed.max())


@COLOURS
def test_a_grain_too_far_off_to_shade_changes_nothing(sigma_a):
    material = medium("dielectric", sigma_a)
    away = numpy.eye(4)
    away[:3, 3] = (0.0, 40.0, -3.0)
    other = native.Instance(sphere(16, 8), native.Material(model="lambert"), away)
    together, apart = picture(material), picture(material, others=[other])
    numpy.testing.assert_allclose(together, apart, atol=2e-3 * together.max())


def test_sums_are_made_anew_for_other_lights():
    material = medium("dielectric", (0.3,) * 3)
    view = native.View(64, 64)
    draw(view, material)
    brighter = tuple((to_light, tuple(2.0 * number for number in irradiance)) for to_light, irradiance in SUNS)
    for suns in (brighter, SUNS[:1], SUNS[::-1]):
        again = draw(view, material, suns=suns)
        numpy.testing.assert_allclose(again, picture(material, suns=suns), atol=2e-3 * again.max())


def test_walks_meet_light_that_was_followed_in_as_what_they_look_for_by_themselves():
    material = medium("dielectric", (0.3,) * 3, g=0.85, sigma_s=(20.0,) * 3)
    faint = native.PointLight((0.0, 0.0, 1000.0), (1e-9,) * 3)
    found, anew = (picture(material, lamps=lamps, samples=64) for lamps in ([], [faint]))
    for channel in range(3):
        assert abs(found[..., channel].sum() / anew[..., channel].sum() - 1.0) < 0.03
    found, anew = found.sum(axis=2), anew.sum(axis=2)
    assert numpy.abs(blocks(found) - blocks(anew)).sum() < 0.06 * blocks(anew).sum()


def test_each_of_the_suns_that_share_what_was_followed_in_has_its_colour():
    material = medium("dielectric", (0.3,) * 3, g=0.85, sigma_s=(20.0,) * 3)
    away = numpy.eye(4)
    away[:3, 3] = (0.0, 40.0, -3.0)
    other = native.Instance(sphere(16, 8), native.Material(model="lambert"), away)
    shared, apart = (picture(material, others=others, samples=64) for others in ([], [other]))
    for channel in range(3):
        found, known = blocks(shared[..., channel]), blocks(apart[..., channel])
        assert numpy.abs(found - known).sum() < 0.05 * known.sum()


@pytest.mark.parametrize("to_light", [(0.5, 0.5, 0.7), (0.8, 0.6, 0.0), (0.0, 0.0, 1.0)])
def test_walks_in_a_cube_with_flat_faces_are_numbers(to_light):
    view = native.View(48, 48)
    material = medium("dielectric", (0.1,) * 3, g=0.85, sigma_s=(8.0,) * 3)
    view.set_scene(native.Scene(instances=[native.Instance(cube(), material, numpy.eye(4))],
                                lights=[native.DirectionalLight(to_light, (1.0,) * 3)]))
    view.set_camera(native.Camera.look_at((2.0, 1.5, 5.0), (0.0,) * 3, (0.0, 1.0, 0.0), 28.0))
    view.render(16)
    assert numpy.isfinite(view.read()).all()

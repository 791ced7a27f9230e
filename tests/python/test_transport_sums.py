"""What is stored for `transport` is summed once for each sun; where lamps shine, at each pixel: the same picture."""

import mesograin_native as native
import numpy
import pytest

from test_transport_colours import sphere

SUNS = (((0.5, 0.5, 0.7), (1.0, 0.8, 0.6)), ((-0.4, 0.3, -0.85), (0.5, 1.0, 0.2)))
TURN = numpy.array([[0.6, -0.8, 0.0, 0.1], [0.8, 0.6, 0.0, -0.05], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]])


def picture(material, lamps):
    """(64, 64, 3)."""
    view = native.View(64, 64)
    suns = [native.DirectionalLight(to_light, irradiance) for to_light, irradiance in SUNS]
    view.set_scene(native.Scene(instances=[native.Instance(sphere(48, 24), material, TURN)], lights=suns + lamps))
    view.set_camera(native.Camera.look_at((0.0, 0.0, 6.5), (0.0,) * 3, (0.0, 1.0, 0.0), 22.0))
    view.render(4)
    return view.read()[..., :3]


@pytest.mark.parametrize("boundary", ["index_matched", "dielectric"])
@pytest.mark.parametrize("sigma_a", [(0.3, 0.3, 0.3), (0.1, 0.5, 1.5)], ids=["grey", "coloured"])
def test_a_lamp_too_faint_to_see_changes_nothing(boundary, sigma_a):
    material = native.Material(model="transport", boundary=boundary, specular=False, sigma_a=sigma_a,
                               sigma_s=(3.0,) * 3)
    faint = native.PointLight((0.0, 0.0, 1000.0), (1e-9,) * 3)
    summed, anew = picture(material, []), picture(material, [faint])
    assert summed.max() > 0.1
    # The second picture may read what is stored from a file, which has it in half precision.
    numpy.testing.assert_allclose(summed, anew, atol=2e-3 * summed.max())

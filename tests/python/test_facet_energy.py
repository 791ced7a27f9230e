"""What rough facets make of light from everywhere: with energy kept, all of it comes back."""
import mesograin_native as native
import numpy
import pytest
from test_portions import BALL, SIZE

SAMPLES = 64


def furnace(material):
    """Mean linear RGB of a ball in a white world, over what is well within its outline."""
    view = native.View(SIZE, SIZE)
    view.set_scene(native.Scene(instances=[native.Instance(BALL, material)],
                                world=native.World(radiance=(1.0, 1.0, 1.0))))
    view.set_camera(native.Camera.look_at((0.0, 0.0, 5.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 24.0))
    view.render(SAMPLES)
    picture = view.read()
    x, y = numpy.meshgrid(*[(numpy.arange(SIZE) + 0.5) / SIZE - 0.5] * 2)
    inner = numpy.hypot(x, y) < 0.4
    assert picture[inner, 3].min() == 1.0
    return picture[inner, :3].astype(numpy.float64).mean(axis=0)


@pytest.mark.parametrize("roughness", [0.2, 0.6, 1.0])
def test_white_metal_sends_back_all_it_gets(roughness):
    def metal(**finish):
        return native.Material(model="conductor", reflectance=(1.0, 1.0, 1.0), roughness=roughness,
                               finish=native.Finish(metal_whitens=True, **finish))

    assert furnace(metal(facets_keep_energy=True)) == pytest.approx((1.0, 1.0, 1.0), abs=0.02)
    assert furnace(metal())[0] < 1.0 - 0.3 * roughness


@pytest.mark.parametrize("roughness", [0.3, 0.8])
def test_a_white_base_under_a_coat_sends_back_all_it_gets(roughness):
    coated = native.Finish(coat=0.2, coat_roughness=roughness, coat_shades_base=True, facets_keep_energy=True)
    material = native.Material(model="lambert", reflectance=(1.0, 1.0, 1.0), finish=coated)
    assert furnace(material) == pytest.approx((1.0, 1.0, 1.0), abs=0.02)


def test_light_that_met_many_facets_has_more_colour():
    def metal(**finish):
        return native.Material(model="conductor", reflectance=(0.9, 0.5, 0.1), roughness=1.0,
                               finish=native.Finish(**finish))

    kept, lost = furnace(metal(facets_keep_energy=True)), furnace(metal())
    gain = kept / lost
    assert gain[0] > gain[1] > gain[2] > 1.0
    assert numpy.all(kept < (0.9, 0.5, 0.1))

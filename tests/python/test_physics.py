"""The physics numbers that scripts can ask for."""

import mesograin_native as native
import pytest


def test_half_space_albedo_of_an_index_matched_medium():
    # Chandrasekhar 1960: 1 - sqrt(1 - albedo) H(1) = 0.415 for albedo 0.9; Monte Carlo gives 0.4147.
    material = native.Material(model="model_1", boundary="index_matched", sigma_a=(0.1,) * 3, sigma_s=(0.9,) * 3)
    assert native.half_space_albedo(material, 1.0) == pytest.approx([0.4149] * 3, abs=2e-4)


def test_diffusion_boundary_agrees_with_quadrature():
    boundary = native.diffusion_boundary(1.3)
    assert boundary["a"] == pytest.approx(2.340, abs=1e-3)
    assert boundary["exit_transmittance"] == pytest.approx(0.9389, abs=1e-4)


@pytest.mark.parametrize("call", [lambda: native.half_space_albedo(native.Material(), 0.0),
                                  lambda: native.diffusion_boundary(float("nan"))])
def test_a_bad_argument_is_one_sentence(call):
    with pytest.raises(native.Error, match=r"must lie .*; got .*\."):
        call()

"""Models 2 and 3 as they are drawn, where scattering is not isotropic, against photon Monte Carlo."""

import pathlib
import sys

import mesograin_native as native
import numpy
import pytest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "bench"))
import anisotropic  # noqa: E402
import sphere_exitance  # noqa: E402


@pytest.fixture(scope="module", name="bench")
def bench_fixture():
    return anisotropic.Bench(native)


@pytest.mark.parametrize("model", ["model_2", "model_3"])
@pytest.mark.parametrize("g, bar, bar_of_total", [(-0.5, 0.08, 0.06), (0.6, 0.11, 0.1), (0.85, 0.22, 0.2)])
def test_light_scattered_forwards_is_kept(bench, model, g, bar, bar_of_total):
    """Orders two, three and so on of forward scattering are neither lost nor counted twice."""
    for case in bench.cases():
        if case["g"] != g or case["radius"] not in (0.6, 2.4):
            continue
        for row in bench.measure(case, model, 64):
            what = f"g {g}, eta {case['eta']}, radius {case['radius']}, albedo {row['albedo']}: {row}"
            assert row["relative_l1"] < bar, what
            assert abs(row["total"] - 1.0) < bar_of_total, what


@pytest.mark.parametrize("g", [0.85, 0.95])
@pytest.mark.parametrize("radius", [0.6, 2.4])
def test_transport_keeps_all_of_the_light_that_scatters_forwards(bench, g, radius):
    case = next(case for case in bench.cases() if (case["eta"], case["g"], case["radius"]) == (1.3, g, radius))
    white = next(row for row in bench.measure(case, "transport", 0) if row["albedo"] == 0.999)
    assert white["total"] == pytest.approx(1.0, abs=0.015)


@pytest.mark.parametrize("g, radius", [(0.3, 0.6), (0.5, 2.4), (0.9, 7.2)])
def test_no_sample_in_millions_stands_out(bench, monkeypatch, g, radius):
    """What is hardly ever drawn weighs no more than what is always: dots would stay for thousands of frames."""
    monkeypatch.setattr(sphere_exitance, "SIZE", 1000)
    albedo = numpy.array(bench.table["albedos"])
    view = native.View(1000, 1000)
    view.set_taps(16)
    made_of = native.Material(model="model_3", sigma_s=tuple(albedo * radius), sigma_a=tuple((1.0 - albedo) * radius),
                              g=g, eta=1.0, boundary="index_matched", specular=False)
    view.set_scene(native.Scene(
        instances=[native.Instance(sphere_exitance.sphere(native), made_of, numpy.eye(4))],
        lights=[native.DirectionalLight((0.0, 1.0, 0.0), (1.0, 1.0, 1.0))]))
    for camera, inside, _, _ in sphere_exitance.Cameras(native, views=8, facing_power=2).views[3:6:2]:
        view.set_camera(camera)
        view.render(1)
        brightest = view.read()[..., :3].max(axis=-1)[inside]
        assert brightest.max() < 5.0 * numpy.quantile(brightest, 0.9995)


@pytest.mark.parametrize("model", ["model_2", "model_3"])
@pytest.mark.parametrize("g", [0.6, 0.85])
@pytest.mark.parametrize("radius", [0.6, 2.4, 7.2])
def test_light_scattered_forwards_crosses_between_lambert_surfaces(bench, model, g, radius):
    """There it leaves diffused, as light does that nothing has met."""
    case = next(case for case in bench.table["cases"]
                if (case["entry"], case["g"], case["radius"]) == ("lambert", g, radius))
    albedo = numpy.array(bench.table["albedos"])
    made_of = native.Material(model=model, sigma_s=tuple(albedo * radius), sigma_a=tuple((1.0 - albedo) * radius), g=g,
                              boundary="lambert_lambert")
    view = native.View(sphere_exitance.SIZE, sphere_exitance.SIZE)
    view.set_taps(64)
    instance = native.Instance(sphere_exitance.sphere(native), made_of, numpy.eye(4))
    view.set_scene(native.Scene(instances=[instance],
                                lights=[native.DirectionalLight((0.0, 1.0, 0.0), (1.0, 1.0, 1.0))]))
    exitance = sphere_exitance.Cameras(native).exitance(view, 1, bench.table["bins"])
    for channel, scattered in enumerate(case["scattered"]):
        truth = numpy.array(scattered) + numpy.array(case["ballistic"])
        assert abs(exitance[:, channel].sum() / truth.sum() - 1.0) < 0.08
        assert numpy.abs(exitance[:, channel] - truth).sum() < 0.1 * truth.sum()

"""A match finds the coefficients that a picture was drawn with, says what a picture does not tell, and goes on where it
was stopped."""

import io
import json
import pathlib
import subprocess
import sys

import mesograin_native as native
import numpy
import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "addon"))

from mesograin.studies.comparison.progress import Cancelled, Progress  # noqa: E402
from mesograin.studies.match import blocks, certainty, files, keeping, least_squares, scenes, search  # noqa: E402
from mesograin.studies.match import subject, target  # noqa: E402

SIGMA_S, SIGMA_A = (2.0, 3.0, 1.0), (0.1, 0.3, 0.7)
UNKNOWN = {"sigma_s": 1.0, "sigma_a": 1.0}


def described(shape="cube", light=(0.5, 0.5, 0.70710678), **medium):
    geometry = {"shape": "sphere", "radius": 2.4} if shape == "sphere" else {
        "shape": "mesh", "file": str(SOURCE / "tests/data/shapes/cube.obj")}
    return {"geometry": geometry, "resolution": [96, 96],
            "camera": {"position": [0, 0, 6.5], "look_at": [0, 0, 0], "up": [0, 1, 0], "fov_degrees": 45},
            "lights": [{"type": "distant", "direction_to_light": list(light), "irradiance_linear_rgb": 3.0}],
            "material": {"kind": "subsurface", "eta": 1.3, "specular": False, **medium}}


def drawn(scene, model="model_2", seed=7, samples=64):
    """(h, w, 4): as somebody else draws it."""
    made, camera, size = native.load_scene(scene, model=model)
    view = native.View(*size, seed=seed)
    view.set_scene(made)
    view.set_camera(camera)
    view.render(samples)
    return view.read()


def matched(tmp_path, pixels, scene, model="model_2", parameters=("sigma_a", "sigma_s"), exposure=False, longest=96,
            masks=(), path=None, progress=None):
    (tmp_path / "scene.json").write_text(json.dumps(scene))
    whole = target.linear("picture", pixels)
    of, small, factor = scenes.read(native, tmp_path / "scene.json", whole, longest, 16)
    request = search.Request(parameters, model, exposure, keeping.keep(masks, whole, small, factor, None), path)
    progress = progress or Progress(io.StringIO())
    progress.plan(search.steps(request, 0.1))
    return search.search(native, of, small, request, progress)


@pytest.fixture(scope="module")
def picture():
    return drawn(described(sigma_s=SIGMA_S, sigma_a=SIGMA_A))


def test_coefficients_are_found_again(tmp_path, picture):
    found = matched(tmp_path, picture, described(**UNKNOWN))
    assert found.converged and found.renders <= 40
    assert found.coefficients["sigma_s"] == pytest.approx(SIGMA_S, rel=0.02)
    assert found.coefficients["sigma_a"] == pytest.approx(SIGMA_A, rel=0.02)
    for name, truth in (("sigma_s", SIGMA_S), ("sigma_a", SIGMA_A)):
        for entry, true in zip(found.intervals[name], truth):
            assert entry["determined"] and entry["low"] <= true <= entry["high"]
            assert entry["high"] < 1.1 * entry["low"]


@pytest.mark.parametrize("sigma_s, sigma_a, bounded", [
    ((3.0, 4.0, 5.0), (0.05, 0.2, 0.5), False), ((5.6, 5.6, 5.6), (8e-4, 1.6e-3, 8e-3), True)])
def test_coefficients_are_found_in_another_models_picture(tmp_path, sigma_s, sigma_a, bounded):
    """Of which model_2 is off by 1 % of brightness and no shape, as little absorption would be."""
    pixels = drawn(described("sphere", sigma_s=sigma_s, sigma_a=sigma_a), "model_3", samples=16)
    found = matched(tmp_path, pixels, described("sphere", **UNKNOWN), "model_2")
    assert found.coefficients["sigma_s"] == pytest.approx(sigma_s, rel=0.1)
    for name, truth in (("sigma_s", sigma_s), ("sigma_a", sigma_a)):
        for entry, true in zip(found.intervals[name], truth):
            assert entry["low"] <= true <= entry["high"], (name, entry)
            assert entry["value"] == pytest.approx(true, rel=0.11) or entry["bounded"], (name, entry)
    assert found.intervals["sigma_a"][0]["bounded"] == bounded


def test_one_coefficient_and_a_brightness_that_nobody_knows(tmp_path, picture):
    scene = described(sigma_s=SIGMA_S, sigma_a=0.2)
    found = matched(tmp_path, 2.0 * picture, scene, parameters=("sigma_a",), exposure=True)
    assert found.coefficients["sigma_s"] == SIGMA_S
    assert found.coefficients["sigma_a"] == pytest.approx(SIGMA_A, rel=0.1)
    assert found.exposure == pytest.approx(2.0, rel=0.05)


@pytest.mark.parametrize("shape, g, determined", [("cube", 0.5, True), ("cube", 0.8, True), ("sphere", 0.2, False)])
def test_g_is_found_with_the_rest_or_said_not_to_be(tmp_path, shape, g, determined):
    medium = {"sigma_s": (4.0, 6.0, 2.0), "sigma_a": SIGMA_A}
    found = matched(tmp_path, drawn(described(shape, g=g, **medium), samples=16), described(shape, g=0.1, **UNKNOWN),
                    parameters=("sigma_a", "sigma_s", "g"))
    assert found.coefficients["sigma_a"] == pytest.approx(medium["sigma_a"], rel=0.1)
    reduced = numpy.multiply(1.0 - found.coefficients["g"], found.coefficients["sigma_s"])
    assert reduced == pytest.approx(numpy.multiply(1.0 - g, medium["sigma_s"]), rel=0.1)
    stated, = found.intervals["g"]
    assert stated["low"] <= g <= stated["high"] and stated["determined"] == determined, stated
    if determined:
        assert stated["high"] - stated["low"] < 0.45


def test_what_a_picture_does_not_tell_is_said(tmp_path):
    """Light of an opaque grain's model leaves where it enters: the picture has its colour, and no length."""
    found = matched(tmp_path, drawn(described(sigma_s=SIGMA_S, sigma_a=SIGMA_A), "model_1"), described(**UNKNOWN),
                    "model_1")
    assert not any(entry["determined"] for entry in found.intervals["mean_free_path"])
    assert numpy.divide(found.coefficients["sigma_s"], found.coefficients["sigma_a"]) == pytest.approx(
        numpy.divide(SIGMA_S, SIGMA_A), rel=0.05)
    results = files.describe(found, "unit", 1.0, {})
    assert "does not determine sigma_a of red, green, blue and sigma_s of" in files.sentence(results)


@pytest.mark.parametrize("seed", [7, 8, 9])
def test_an_absorption_that_is_too_little_to_be_seen_is_bounded(tmp_path, seed):
    """Sugar, 11 mean free paths wide: a tenth more of the first two changes blocks by less than their noise."""
    sigma_s, sigma_a = (5.6, 5.6, 5.6), (8e-4, 1.6e-3, 8e-3)
    found = matched(tmp_path, drawn(described(sigma_s=sigma_s, sigma_a=sigma_a), seed=seed), described(**UNKNOWN))
    assert found.coefficients["sigma_s"] == pytest.approx(sigma_s, rel=0.02)
    for entry, true in zip(found.intervals["sigma_a"], sigma_a):
        assert entry["low"] <= true <= entry["high"], entry
        assert not entry["determined"] or entry["value"] == pytest.approx(true, rel=0.1), entry
    assert [entry["bounded"] for entry in found.intervals["sigma_a"]] == [True, True, False]
    assert not any(entry["bounded"] for entry in found.intervals["sigma_s"])
    told = files.sentence(files.describe(found, "unit", 1.0, {}))
    assert told.count("at most") == 2 and "the picture does not determine sigma_a of red, green" in told


@pytest.mark.parametrize("sigma_s, scattering_known, bounded", [
    (5.0, True, True), (5.0, False, False), (0.2, True, False)])
def test_only_little_absorption_beside_a_known_scattering_is_bounded(sigma_s, scattering_known, bounded):
    intervals = {"sigma_s": [certainty.interval("sigma_s", sigma_s, 0.01 if scattering_known else 1.0)],
                 "sigma_a": [certainty.interval("sigma_a", 0.005, 1.0)]}
    assert intervals["sigma_a"][0]["high"] == pytest.approx(0.037, rel=0.01)
    [entry] = certainty.bound(intervals, (sigma_s,))["sigma_a"]
    assert entry["bounded"] == bounded
    [alone] = certainty.bound({"sigma_a": intervals["sigma_a"]}, (sigma_s,))["sigma_a"]
    assert alone["bounded"] == (sigma_s == 5.0)
    assert certainty.bound({"g": []}, (sigma_s,)) == {"g": []}


def test_it_goes_on_where_it_was_stopped(tmp_path, picture):
    path = tmp_path / "renders.jsonl"

    class Impatient(Progress):
        def begin(self):
            super().begin()
            if self.steps_left == 9:
                self.cancel()

    scene = described(**UNKNOWN)
    with pytest.raises(Cancelled):
        matched(tmp_path, picture, scene, path=path, progress=Impatient(io.StringIO()))
    kept = len(path.read_text().splitlines()) - 1
    assert kept > 3
    found = matched(tmp_path, picture, scene, path=path)
    assert found.remembered == kept < found.renders
    again = matched(tmp_path, picture, scene, path=path)
    assert again.remembered == again.renders and again.coefficients == found.coefficients
    scene["lights"][0]["irradiance_linear_rgb"] = 4.0  # another scene's pictures are none of this one's
    assert matched(tmp_path, picture, scene, path=path).remembered == 0


def test_a_large_picture_is_made_small_and_cropped(tmp_path, picture):
    large = numpy.kron(picture, numpy.ones((3, 3, 1), numpy.float32))[:, :-1]
    large[:100] = numpy.nan
    scene = {**described(**UNKNOWN), "resolution": [287, 288]}
    found = matched(tmp_path, large, scene, masks=[("crop", (0, 120, 287, 288))])
    assert found.picture.shape == (96, 95, 4) and not found.mask[:30].any() and found.mask.any()


class TestErrors:
    @pytest.mark.parametrize("scene, pixels, sentence", [
        ({**described(), "material": {"kind": "diffuse", "reflectance": 0.5}}, None, "no grain whose coefficients"),
        (described(**UNKNOWN), numpy.full((96, 96, 3), numpy.nan), "No pixel is left to be matched"),
        ({**described(**UNKNOWN), "camera": {"position": [0, 0, 6.5], "look_at": [0, 0, 9], "fov_degrees": 45}}, None,
         "the camera sees no grain"),
    ])
    def test_what_cannot_be_matched(self, tmp_path, picture, scene, pixels, sentence):
        with pytest.raises(subject.SubjectError, match=sentence):
            matched(tmp_path, picture if pixels is None else pixels, scene)

    def test_what_is_no_picture(self, tmp_path):
        with pytest.raises(target.TargetError, match="3 or 4 channels"):
            target.linear("it", numpy.zeros((32, 32)))
        with pytest.raises(target.TargetError, match="8 x 32 pixels"):
            target.linear("it", numpy.zeros((32, 8, 3)))
        native.write_exr(str(tmp_path / "depth.exr"), numpy.zeros((32, 32, 1), numpy.float32), ["Z"])
        with pytest.raises(target.TargetError, match="it has Z"):
            target.read(native, tmp_path / "depth.exr")
        with pytest.raises(target.TargetError, match="rectangle within"):
            keeping.keep([("crop", (0, 0, 99, 9))], *(target.linear("it", numpy.zeros((32, 32, 3))),) * 2, 1, None)

    @pytest.mark.parametrize("words, sentence", [
        (("scene.json", "picture.png"), "EXR files"),
        (("scene.json", "none.exr"), "there is no picture"),
        (("scene.json", "picture.exr", "--material", "Sand"), "--material needs a .blend scene"),
        (("scene.json", "picture.exr", "--parameters", "eta"), "names of sigma_a, sigma_s, g"),
        (("scene.json", "picture.exr", "--mask", "crop:1,2"), "four whole numbers"),
        (("scene.json", "picture.exr"), "lights is missing"),
    ])
    def test_a_command_line(self, tmp_path, picture, words, sentence):
        (tmp_path / "scene.json").write_text("{}")
        (tmp_path / "picture.png").touch()
        native.write_exr(str(tmp_path / "picture.exr"), picture)
        outcome = command(tmp_path, *words)
        assert outcome.returncode == 2 and sentence in outcome.stderr and len(outcome.stderr.splitlines()) == 1


def command(folder, *words):
    return subprocess.run([sys.executable, SOURCE / "addon/mesograin/studies/match/json_command.py", *words],
                          cwd=folder, capture_output=True, text=True)


def test_the_command_writes_what_it_found(tmp_path, picture):
    (tmp_path / "scene.json").write_text(json.dumps(described(sigma_s=SIGMA_S, sigma_a=0.2)))
    native.write_exr(str(tmp_path / "picture.exr"), picture)
    outcome = command(tmp_path, "scene.json", "picture.exr", "--parameters", "sigma_a", "--model", "model_2",
                      "--samples", "8", "--size", "48")
    assert outcome.returncode == 0, outcome.stderr
    told = json.loads((tmp_path / "match/match.json").read_text())
    assert told["sigma_a"] == pytest.approx(SIGMA_A, rel=0.1) and told["unit"] == "1/unit" and told["complete"]
    assert outcome.stdout.startswith("sigma_a 0.") and "after" in outcome.stdout
    for name in told["files"].values():
        assert native.read_exr(str(tmp_path / "match" / name))[0].shape[:2] == (48, 48)


class TestLeastSquares:
    """Of functions whose answer is known."""

    PATTERN = numpy.kron(numpy.eye(3, dtype=bool), numpy.ones((1, 2), bool))

    def test_channels_that_are_apart_share_their_pictures(self):
        assert least_squares.columns(self.PATTERN) == [[0, 2, 4], [1, 3, 5]]
        assert [unknowns.tolist() for unknowns, _ in least_squares.parts(self.PATTERN)] == [[0, 1], [2, 3], [4, 5]]
        shared = numpy.hstack((self.PATTERN, numpy.ones((3, 1), bool)))
        assert least_squares.columns(shared) == [[0, 2, 4], [1, 3, 5], [6]]
        assert len(least_squares.parts(shared)) == 1

    def test_rosenbrock_s_valley(self):
        """Rosenbrock, 1960: a curved valley whose floor is at 1, 1; here three, each scaled otherwise."""
        looked = []

        def residuals(state):
            looked.append(state)
            x, y = state.reshape(3, 2).T
            return numpy.stack([10.0 * (y - x * x), 1.0 - x], axis=1) * [[1.0], [3.0], [2.0]]

        found = least_squares.minimise(residuals, numpy.tile([-1.2, 1.0], 3), self.PATTERN, numpy.full(6, 1e-4),
                                       (numpy.full(6, -9.0), numpy.full(6, 9.0)), 50, 1e-6)
        assert found.converged and found.state == pytest.approx(numpy.ones(6), abs=1e-3)
        assert len(looked) < 150

    def test_a_limit_holds(self):
        found = least_squares.minimise(lambda state: (state - 5.0)[:, None] * numpy.ones((1, 4)), numpy.zeros(1),
                                       numpy.ones((1, 1), bool), numpy.full(1, 0.1), (-numpy.ones(1), numpy.ones(1)))
        assert found.state == pytest.approx([1.0])

    def test_intervals_hold_the_truth_as_often_as_they_say(self):
        random = numpy.random.default_rng(1)
        slopes = random.normal(size=(1, 64, 2))
        truth, inside = numpy.array([0.3, -0.2]), 0
        for _ in range(200):
            noise = random.normal(size=(1, 64))
            state = numpy.linalg.lstsq(slopes[0], (slopes @ truth + noise)[0], rcond=None)[0]
            fit = least_squares.Fit(state, slopes @ state - slopes @ truth - noise, slopes, True, 1)
            spread = certainty.covariance(fit, numpy.ones((1, 2), bool), numpy.arange(64) // 4,
                                          random.normal(size=(1, 64)), numpy.ones((1, 64)), slopes)
            inside += int(abs(state[0] - truth[0]) <= 2.0 * spread[0, 0]**0.5)
        assert 188 <= inside

    def test_intervals_hold_the_truth_of_a_model_that_is_off(self):
        """Its error is smooth, and so is what the unknowns do, which explain half of it away. With two patterns left,
        two deviations are 82 % by Student's distribution."""
        random = numpy.random.default_rng(3)
        along = numpy.linspace(-1.0, 1.0, 64)
        patterns = numpy.polynomial.legendre.legvander(along, certainty.PATTERNS - 1)
        inside, widths = 0, []
        for _ in range(200):
            slopes = (patterns @ random.normal(size=(certainty.PATTERNS, 2)))[None]
            error = patterns @ random.normal(size=certainty.PATTERNS)
            state = -numpy.linalg.lstsq(slopes[0], error, rcond=None)[0]
            fit = least_squares.Fit(state, slopes @ state + error, slopes, True, 1)
            spread = certainty.covariance(fit, numpy.ones((1, 2), bool), numpy.arange(64) // 4, numpy.ones((1, 64)),
                                          numpy.zeros((1, 64)), slopes)
            inside += int(abs(state[0]) <= 2.0 * spread[0, 0]**0.5)
            widths.append(2.0 * spread[0, 0]**0.5 / abs(state[0]))
        assert 155 <= inside
        assert numpy.median(widths) < 10.0, "and they say something"


def test_noise_is_told_from_shape():
    random = numpy.random.default_rng(2)
    slope = numpy.add.outer(numpy.linspace(1.0, 2.0, 64), numpy.linspace(0.0, 1.0, 64))[..., None] * numpy.ones(3)
    noisy = slope + random.normal(scale=0.5, size=slope.shape)
    mask = numpy.ones((64, 64), bool)
    told = blocks.Blocks(mask, noisy)
    variance = 1.0 / told.weights**2 - 0.02**2 * (told.means**2 + (0.1 * told.means.mean(axis=1)[:, None]) ** 2)
    assert numpy.sqrt(variance.mean()) == pytest.approx(0.5 / 8.0, rel=0.1)
    plain = blocks.Blocks(mask, slope)
    assert plain.weights == pytest.approx(1.0 / (0.02 * plain.means), rel=0.02)


def test_small_grains_are_no_noise():
    """A picture that is rough from pixel to pixel, and another one of the same with noise."""
    random = numpy.random.default_rng(4)
    rough = 2.0 + random.uniform(-1.5, 1.5, size=(64, 64, 1)) * numpy.ones(3)
    noisy = rough + random.normal(scale=0.2, size=rough.shape)
    told = blocks.Blocks(numpy.ones((64, 64), bool), noisy)
    found = numpy.sqrt(told.noise(noisy, rough).mean(axis=1) / (told.weights**2).mean(axis=1))
    assert found == pytest.approx(0.2 / 8.0, rel=0.1)
    assert told.noise(noisy, 0.0 * rough) == pytest.approx(told.noise(noisy, 0.0 * rough + 7.0))
    assert numpy.all(told.noise(noisy, 0.0 * rough) > 4.0 * told.noise(noisy, rough))


def test_codes_become_light():
    codes = numpy.zeros((32, 32, 3), numpy.float32)
    codes[:, 16:], codes[16:, :16] = 0.5, 1.0
    made = target.of_codes("it", codes)
    assert made.pixels[0, 20, 0] == pytest.approx(0.21404, abs=1e-5)
    assert made.usable[0, 0] and not made.usable[20, 0]

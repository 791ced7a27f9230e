"""The report from synthetic results: self-contained, complete, true to its pictures, and clear about bad input."""

import base64
import html
import json
import re
import subprocess
import sys
import zlib

import mesograin_native as native
import numpy as np
import pytest
from addon_rooms import ADDON, room

colours = room("report.colours")
payload = room("report.payload")
plots = room("report.plots")
wording = room("report.wording")
definitions = room("studies.comparison.definitions")
LABELS = room("cycles.wording").LABELS

# Of results.json, beside those that its first case has here.
KEYS = ("mask_steps", "judged_by", "false_alarm_rate", "most_seeds", "noise_floor", "metric_corrected", "our_noise")

BUILDER = ADDON / "mesograin" / "report" / "build.py"


def disc(size=48, gain=1.0):
    """A lit disc with coverage, (size, size, 4)."""
    y, x = np.mgrid[:size, :size] / (size - 1) * 2.0 - 1.0
    inside = (x**2 + y**2 < 0.8).astype(np.float32)
    light = gain * np.clip(1.5 + x - y, 0.0, None) * inside
    return np.stack([light, 0.8 * light, 0.5 * light, inside], axis=-1).astype(np.float32)


def write_case(folder, name, model, reference, **changes):
    (folder / name).mkdir(parents=True)
    compared = native.compare(model, reference, 1.01 * reference)
    groups = {group: compared.pop(group) for group in ("noise_floor", "mask")}
    del compared["epsilon"], compared["block_size"]
    files = {}
    for picture, pixels in (("model", model), ("reference", reference), ("error", model - reference)):
        files[picture] = f"{name}/{picture}.exr"
        native.write_exr(folder / files[picture], pixels[..., :3] if picture == "error" else pixels)
    files["mask"] = f"{name}/mask.exr"
    native.write_exr(folder / files["mask"], native.default_mask(reference[..., 3]).astype(np.float32)[..., None])
    for picture in ("model_png", "reference_png", "error_png", "signed_error_png"):
        import matplotlib.image

        files[picture] = f"{name}/{picture}.png"
        matplotlib.image.imsave(folder / files[picture], colours.expose(model, 0.0))
    return {
        "name": name,
        "scene": "disc.blend",
        "model": name.split(".")[0],
        "reference": "diffuse",
        "reference_title": "Cycles Diffuse",
        "boundary": "",
        "status": "done",
        "metrics": compared,
        **groups,
        "material": {"Sand <b>": {"sigma_s": [0.9] * 3, "g": 0.1}},
        "samples": 4,
        "our_seconds": 0.8,
        "frame_ms": 2.5,
        "frames_timed": 3,
        "passes_ms": {"shade": 2.5},
        "reference_samples": 8,
        "reference_seeds": [1, 2],
        "reference_seconds": 12.0,
        "reference_cached": False,
        "reference_bounces": 0,
        "notes": [],
        "files": files,
        "exposure_stops": -1.5,
        "versions": {},
        **changes,
    }


def write_folder(tmp_path):
    """A folder with the results of three cases, one of them failed."""
    reference = disc()
    cases = [
        write_case(tmp_path, "lambert.diffuse", 1.003 * reference, reference),
        write_significance(
            tmp_path,
            write_case(tmp_path, "model_1.volume_index_matched", 1.4 * reference, reference,
                       notes=["Cycles <cannot> do this with volume_dielectric."], boundary="index_matched",
                       own_boundaries=["dielectric"],
                       reference_title="Cycles volume, index-matched", passes_ms={"light_maps": 2.5},
                       material={"Grain": {"model": "model_1", "boundary": "index_matched", "profile": "half_space",
                                           "specular": False, "sigma_a": [0.1, 0.2, 0.3]}}),
        ),
        {
            "name": "model_2.subsurface_burley",
            "model": "model_2",
            "reference_title": "Cycles volume",
            "status": "failed",
            "material": {},
            "reference": "volume",
            "error": "Out of <memory> for subsurface_burley.",
        },
    ]
    results = {
        "format": "mesograin-results",
        "format_version": 1,
        "complete": True,
        "created": "2024-01-02T03:04:05+00:00",
        "command": "./mesograin compare disc.blend --set 'g=0.1'",
        "scene": "disc.blend",
        "size": [48, 48],
        "versions": {"mesograin": "0.1.0", "blender": "3.4.1 (abc)", "python": "3.11", "numpy": "1.24"},
        "device": {"renderer": "llvmpipe", "version": "4.5"},
        "cpu": {"name": "A CPU", "cores": 2},
        "settings": {"pixel_filter": "box", "colour_space": "linear"},
        "definitions": {**definitions.all_definitions(cases[0]["metrics"]),
                        "significance.verdict": "whether <noise> explains it"},
        "cases": cases,
    }
    (tmp_path / "results.json").write_text(json.dumps(results))
    return tmp_path


SIGNIFICANCE = {"verdict": "differs", "pixels": 900, "tests": 2700, "significant_pixels": 90, "share": 0.1,
                "threshold": 1e-5, "score_threshold": 4.4, "false_alarm_rate": 0.01, "relative_tolerance": 0.002,
                "reference_seeds": 4, "our_seeds": 2, "blocks": 20, "significant_blocks": 5, "share_blocks": 0.25,
                "threshold_blocks": 1e-4}


def write_significance(folder, case):
    """Noise, scores and verdict of a case, as a comparison with several seeds writes them."""
    scores = np.zeros((48, 48, 3), np.float32)
    scores[20, 30] = 1.0, -9.0, 2.0
    for name, pixels in (("noise", np.full((48, 48, 3), 0.01, np.float32)), ("z_map", scores)):
        case["files"][name] = f"{case['name']}/{name}.exr"
        native.write_exr(folder / case["files"][name], pixels)
    case["significance"] = SIGNIFICANCE
    found = {**SIGNIFICANCE, "verdict": "no significant difference"}
    case["controls"] = {"identical": SIGNIFICANCE, "wrong": {**found, "change": {"scale": 2.0}}}
    case["our_noise"] = {"relative_l1": 0.0123}
    case["judged_by"] = "relative_l1_blocks"
    case["mask_steps"] = [{"name": "silhouette:2", "pixels": 900, "removed": 100},
                          {"name": "otsu", "pixels": 800, "removed": 100}]
    case["unfiltered"] = {"metrics": {**case["metrics"], "relative_l1": 0.777}, "noise_floor": {}, "mask": {}}
    case["profile"] = {"cosine": [-0.5, 0.0, 0.5], "pixels": [3, 4, 5], "ours": [[1.0, 1.0, 1.0]] * 3,
                       "reference": [[1.1, 1.0, 1.0]] * 3, "noise": [[0.1, 0.1, 0.1]] * 3}
    case["until"] = {"fraction": 0.2, "metric": "relative_l1", "ratio": 0.31, "reached": False, "most_seeds": 4}
    return case


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """The folder after its report was made."""
    folder = write_folder(tmp_path_factory.mktemp("report"))
    done = build(folder)
    assert (done.returncode, done.stderr) == (0, "")
    return folder


def build(folder):
    environment = {"PATH": "/usr/bin:/bin", "MESOGRAIN_NATIVE_DIR": str(native.__file__).rsplit("/", 1)[0]}
    return subprocess.run([sys.executable, str(BUILDER), str(folder)], env=environment, capture_output=True, text=True)


def test_page_needs_nothing_else(built):
    page = (built / "report.html").read_text()
    sources = re.findall(r'(?:src|href)="([^"]*)"', page)
    known = re.compile(r"data:image/png;base64,|#[\w-]+$|[\w.]+/[\w.]+\.(exr|png|svg)$|results\.(json|csv)$")
    assert sources and [source[:80] for source in sources if not known.match(source)] == []
    assert not re.search(r"@import|url\((?!#)|<link", page)
    for source in sources:
        if source.endswith((".exr", ".png", ".svg")):
            assert (built / source).is_file()
    assert not list(built.glob("*.part")) and not list((built / "plots").glob(".*"))


def test_plots_are_files_too(built):
    for name in ("overview", "cost", "lambert.diffuse.profile", "model_1.volume_index_matched.histogram"):
        svg = (built / "plots" / f"{name}.svg").read_text()
        assert svg.rstrip().endswith("</svg>") and "var(--" not in svg
        assert (built / "plots" / f"{name}.png").read_bytes()[:4] == b"\x89PNG"
    for name in ("cost", "model_1.volume_index_matched.profile", "model_1.volume_index_matched.histogram"):
        said = " ".join(re.sub(r"<[^>]*>", " ", (built / "plots" / f"{name}.svg").read_text()).split())
        for needed in ("disc.blend, 48 × 48 pixels", "boundary Index matched", "own noise in a pixel", "W m⁻² sr⁻¹"):
            assert needed in said, (name, needed)
    assert "radiance, W m⁻² sr⁻¹" in (built / "plots/lambert.diffuse.profile.svg").read_text()
    cost = (built / "plots/cost.svg").read_text()
    assert "Cycles Diffuse" in cost and "Model 1" in cost, "Cycles is a point among ours"
    figure = (built / "plots/overview.svg").read_text()
    for words in ("disc.blend, 48 × 48 pixels, against Cycles Diffuse; Cycles volume", "noise in a pixel", "in blocks"):
        assert words in figure, words
    page = (built / "report.html").read_text()
    assert "#010203" not in page, "a plot in the page has the page's colours"


def test_names_in_the_plot_of_costs_cover_nothing():
    def case(model, reference, seconds, error, their_seconds, noise):
        return {"model": model, "reference_title": reference, "our_seconds": seconds,
                "reference_seconds": their_seconds, "metrics": {"relative_l1_corrected": error},
                "noise_floor": {"relative_l1": noise}}

    cases = [case("lambert", "Cycles Diffuse BSDF", 0.33, 0.0003, 0.31, 0.0007),
             case("conductor", "Cycles Glossy BSDF, GGX", 0.23, 0.0016, 0.3, 0.0029),
             case("model_2", "Cycles volume", 0.97, 0.007, 4.4, 0.044),
             case("model_3", "Cycles volume", 0.75, 0.0034, 4.4, 0.044)]
    figure = plots.cost(cases)(plots.PAPER)
    figure.canvas.draw()
    axes = figure.axes[0]
    names = {text.get_text(): text.get_window_extent() for text in axes.texts}
    assert {"Model 3", "Cycles Glossy BSDF, GGX"} <= set(names)
    dots = [axes.transData.transform(line.get_xydata()[0]) for line in axes.lines if len(line.get_xydata()) == 1]
    assert len(dots) == 7
    for name, box in names.items():
        covered = [other for other, its in names.items() if other != name and box.overlaps(its)]
        assert not covered, (name, covered)
        assert not [dot for dot in dots if box.contains(*dot)], name


def test_every_number_has_its_definition_one_click_away(built):
    page = (built / "report.html").read_text()
    asked = set(re.findall(r'popovertarget="([^"]+)"', page))
    assert "define-metrics.relative_l1" in asked and "define-noise_floor.relative_l1" in asked
    for name in asked:
        assert re.search(rf'popover id="{re.escape(name)}"><h3>[^<]+</h3><p>', page), name


def test_page_says_what_happened(built):
    page = (built / "report.html").read_text()
    text = html.unescape(re.sub(r"<[^>]*>", " ", page))
    assert "./mesograin compare disc.blend --set 'g=0.1'" in text
    assert "Out of <memory> for Subsurface Scattering, Christensen-Burley." in text \
        and "Cycles <cannot> do this with Glass" in text and "Sand <b>" in text
    assert "sum |i - r| / sum r" in text and "llvmpipe" in text and "A CPU" in text
    assert page.count('<section class="case"') == 2


def test_page_and_figure_call_things_by_their_labels(built):
    page = re.sub(r"<(script|style).*?</\1>", "", (built / "report.html").read_text(), flags=re.S)
    told = " ".join(re.findall(r'(?:title|alt|aria-label)="([^"]*)"', page))
    text = " ".join(html.unescape(re.sub(r"<[^>]*>", " ", page)).split())
    figure = " ".join(html.unescape(re.sub(r"<[^>]*>", " ", (built / "plots/overview.svg").read_text())).split())
    numbers = json.loads((built / "results.json").read_text())["cases"][0]
    names = {name for name in (*LABELS, "light_maps", *numbers, *numbers["metrics"], *KEYS) if "_" in name}
    assert names > {"index_matched", "model_1", "half_space", "volume_dielectric", "frames_timed", "rse_root_mean"}
    for where, words in (("page", text), ("attributes", told), ("figure", figure)):
        assert {name for name in names if re.search(rf"\b{name}\b", words)} == set(), where
    assert "boundary Index matched instead of Dielectric" in text
    assert "(boundary Index matched instead of Dielectric)" in figure
    assert "specular off" in text and "Model 1 against Cycles volume, index-matched" in text
    assert "here for relative L1: sum |i - r| / sum r" in text
    metrics = [wording.metric(name) for name in numbers["metrics"]]
    assert len(set(metrics)) == len(metrics), "no two are called alike"
    assert "mean root RSE in 8×8 blocks, noise taken off" in metrics
    assert {name for name in metrics if name not in text} == set()


def test_live_pictures_are_the_exr_files(built):
    page = (built / "report.html").read_text()
    live = [json.loads(text) for text in re.findall(r'class="live">(.*?)</script>', page)]
    assert len(live) == 2 and live[1]["stops"] == -1.5
    expected = native.read_exr(built / "model_1.volume_index_matched" / "model.exr")[0][..., :3]
    texts = dict(re.findall(r'<script type="text/plain" id="(\w+)">(.*?)</script>', page))
    np.testing.assert_array_equal(unpack(texts[live[1]["model"]], 48, 48), expected.astype(np.float16))
    mask = unpack(texts[live[1]["mask"]], 48, 48)[..., 0]
    np.testing.assert_array_equal(mask, native.default_mask(disc()[..., 3]))
    assert live[0]["reference"] == live[1]["reference"] and len(texts) == 5, "shared pictures are there once"


def test_significance_is_shown_where_it_was_tested(built):
    page = (built / "report.html").read_text()
    first, second = page.split('<section class="case"')[1:3]
    assert 'data-mode="scores"' not in first and "scores-legend" not in first
    assert 'data-mode="scores"' in second and "4.4" in second and 'popovertarget="define-verdict"' in second
    text = " ".join(html.unescape(re.sub(r"<[^>]*>", " ", second)).split())
    assert "✗ The same material with other seeds is called different in 10.0 % of the pixels and 25.0 %" in text
    assert "✗ A wrong one, scale 2, is not called different." in text and "✗" not in first
    assert "where the truth is known" in html.unescape(page) and 'popover id="define-controls"' in page
    assert "Differs significantly in 10.0 % of 900 pixels and 25.0 % of 20 blocks of 8×8" in text
    assert "noise was 0.200 of the error in relative L1: it is 0.310 of it; 4 seeds were not enough." in text
    assert (built / "plots/model_1.volume_index_matched.by_angle.svg").is_file() and "by_angle" not in first
    overview = page[:page.index('<section class="case"')]
    assert overview.count('popovertarget="define-metrics.relative_l1_blocks_corrected"') == 2, "what to read first"
    assert "1.23 %" in text and "whether <noise> explains it" in html.unescape(page)
    live = json.loads(re.search(r'class="live">(.*?)</script>', second)[1])
    scores = unpack(dict(re.findall(r'id="(\w+)">(.*?)</script>', page))[live["scores"]], 48, 48)[..., 0]
    assert live["threshold"] == 4.4 and scores[20, 30] == -9.0 and np.count_nonzero(scores) == 1


def test_what_the_mask_took_away_is_counted(built):
    page = (built / "report.html").read_text()
    first, second = page.split('<section class="case"')[1:3]
    assert "otsu took 100 away and kept 800" in second and "unfiltered, relative L1 is 77.7 %" in second
    assert '<th class="n">unfiltered</th>' in second and "unfiltered" not in first
    kept = int(native.default_mask(disc()[..., 3]).sum())
    assert f"{kept} of 2304; taken away: {2304 - kept} by the mask (reference coverage)" in page


def unpack(text, width, height):
    """As the page's script does it."""
    octets = np.frombuffer(zlib.decompress(base64.b64decode(text)), np.uint8)
    high, low = octets.reshape(2, -1).astype(np.uint16)
    return np.moveaxis((high << 8 | low).view(np.float16).reshape(-1, height, width), 0, -1)


def test_payload_keeps_extremes():
    pixels = np.array([[[1e9, -1e9, np.nan, 1e-7]]], np.float32)
    np.testing.assert_array_equal(unpack(payload.pack(pixels), 1, 1), [[[65504.0, -65504.0, np.nan, np.float16(1e-7)]]])


def grey(*values):
    """(1, n, 3), the same in every channel."""
    return np.repeat(np.array([values], float)[..., None], 3, axis=-1)


def test_errors_of_opposite_sign_do_not_cancel_in_the_false_colours():
    image, reference = np.array([[[1.5, 1.0, 0.5]]]), np.ones((1, 1, 3))
    np.testing.assert_array_equal(
        colours.false_colour(colours.relative_error(image, reference)), colours.false_colour(grey(1.0 / 1.01 / 3.0))
    )


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_what_is_not_finite_has_a_colour_that_no_error_has(value):
    image = np.full((1, 1, 3), value)
    for paint, table in ((colours.false_colour, colours.SEQUENTIAL), (colours.signed_colour, colours.DIVERGING)):
        shown = paint(colours.relative_error(image, np.ones((1, 1, 3))))[0, 0]
        np.testing.assert_array_equal(shown, colours.NOT_FINITE)
        assert np.abs(table - shown).sum(axis=-1).min() > 0.3


def test_false_colours_are_fixed_and_logarithmic():
    ends = colours.false_colour(grey(0.0, 1e-3, 1.0, 50.0, -1.0))[0]
    np.testing.assert_array_equal(ends[0], colours.SEQUENTIAL[0])
    np.testing.assert_array_equal(ends[1], colours.SEQUENTIAL[0])
    for bright in ends[2:]:
        np.testing.assert_array_equal(bright, colours.SEQUENTIAL[-1])
    middle = colours.false_colour(grey(10.0**-1.5))[0, 0]
    np.testing.assert_allclose(middle, colours.SEQUENTIAL[128], atol=0.02)
    luminance = colours.SEQUENTIAL @ [0.2126, 0.7152, 0.0722]
    assert (np.diff(luminance) > -1e-3).all()


def test_exposure_brings_the_highlights_to_white():
    reference = disc(gain=8.0)
    stops = colours.exposure_for(reference, reference[..., 3] > 0)
    assert np.percentile(reference[..., :3][reference[..., 3] > 0], 99.5) * 2.0**stops == pytest.approx(1.0, rel=0.05)
    assert colours.exposure_for(np.zeros((4, 4, 4), np.float32)) == 0.0
    np.testing.assert_allclose(
        colours.encode_srgb(np.array([0.0, 0.5, 1.0, np.nan, np.inf])), [0.0, 0.735357, 1.0, 0.0, 1.0], atol=1e-6
    )


@pytest.mark.parametrize(
    "damage, sentence",
    [
        (lambda folder: (folder / "results.json").unlink(), "cannot be read"),
        (lambda folder: (folder / "results.json").write_text("{"), "is not JSON"),
        (lambda folder: (folder / "results.json").write_text("{}"), "holds no results"),
        (lambda folder: (folder / "lambert.diffuse" / "model.exr").write_bytes(b"nothing"), "model.exr"),
        (lambda folder: (folder / "lambert.diffuse" / "model_png.png").unlink(), "model_png.png cannot be read"),
    ],
)
def test_bad_results_get_one_sentence(tmp_path, damage, sentence):
    folder = write_folder(tmp_path)
    damage(folder)
    done = build(folder)
    assert done.returncode == 1
    assert sentence in done.stderr and done.stderr.count("\n") == 1 and "Traceback" not in done.stderr
    assert not (folder / "report.html").exists()

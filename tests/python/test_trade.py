"""The trade curve without Blender: the front, the time Cycles needs, the sentences, the command line, the page."""

import html
import json
import re
import subprocess
import sys

import mesograin_native as native
import numpy as np
import pytest
from addon_rooms import ADDON, room

arguments = room("studies.trade.arguments")
curve = room("studies.trade.curve")
plots = room("report.plots")
reading = room("report.reading")
trade_plot = room("report.trade_plot")

BUILDER = ADDON / "mesograin" / "report" / "build.py"


def point(model, samples, milliseconds, error, taps=None, resolved=True):
    return {
        "name": f"{model}.{taps}.{samples}",
        "side": "traced" if model in ("Cycles", "mesograin-referee") else "mesograin",
        "model": model,
        "taps": taps,
        "samples": samples,
        "milliseconds": milliseconds,
        "error": error,
        "resolved": resolved,
        "metrics": {"relative_l1": error + 0.01, "relative_l1_blocks": error, "bias": 1.0, "rse_mean": error**2},
        "picture": f"pictures/{model}.{taps}.{samples}.exr",
    }


def path_tracer(*counts):
    """100 ms a sample, an error of 0.8 at one that falls with the root."""
    return [point("Cycles", count, 100.0 * count, 0.8 / count**0.5) for count in counts]


def test_the_front_is_what_nothing_beats():
    generator = np.random.default_rng(3)
    points = [point("model_1", 1, *pair) for pair in generator.lognormal(0.0, 1.0, (60, 2))]
    found = curve.front(points)
    times, errors = np.array([(each["milliseconds"], each["error"]) for each in points]).T
    beaten = [((times <= time) & (errors <= error) & ((times < time) | (errors < error))).any()
              for time, error in zip(times, errors)]
    assert sorted(found) == [index for index, is_beaten in enumerate(beaten) if not is_beaten]
    assert (np.diff(times[found]) > 0).all() and (np.diff(errors[found]) < 0).all()


@pytest.mark.parametrize("error, milliseconds, known", [
    (0.4, 400.0, "between"),
    (0.3, 100.0 * (0.8 / 0.3) ** 2, "between"),
    (0.01, 640000.0, "beyond"),
    (0.9, 100.0, "below"),
])
def test_traced_time_follows_its_own_points(error, milliseconds, known):
    found = curve.traced_time(path_tracer(1, 4, 16), error)
    assert found == (pytest.approx(milliseconds), known)


def test_without_cycles_nothing_is_claimed():
    points = [point("model_1", 1, 2.0, 0.1)]
    assert curve.traced_time(points, 0.1) == (None, None)
    assert curve.summary(points)[0]["sentence"] == "Model 1 with 1 sample: 10 % at 2 ms."


def test_the_sentence_names_the_cheapest_of_the_good_settings():
    points = [
        point("model_3", 1, 3.0, 0.2, taps=16),
        point("model_3", 4, 12.0, 0.061, taps=16),
        point("model_3", 16, 48.0, 0.06, taps=16),
        point("model_1", 1, 1.0, 0.3),
        *path_tracer(1, 4, 16, 64, 256),
    ]
    entries = curve.summary(points)
    assert [points[entry["point"]]["name"] for entry in entries] == ["model_3.16.4", "model_1.None.1"]
    assert entries[0]["ratio"] == pytest.approx(100.0 * (0.8 / 0.061) ** 2 / 12.0)
    assert entries[0]["sentence"] == (
        "Model 3 with 4 samples of 16 taps: 6.1 % at 12 ms; Cycles needs 17 s for the same error: 1400×."
    )


def test_an_error_below_the_noise_is_a_bound():
    metrics = {"relative_l1_corrected": 0.001}
    placed = curve.place(metrics, {"relative_l1": 0.04})
    assert placed == {"error": pytest.approx(0.01), "resolved": False}
    assert curve.place({"relative_l1_corrected": 0.02}, {"relative_l1": 0.04}) == {"error": 0.02, "resolved": True}
    entry = curve.summary([point("model_2", 1, 5.0, 0.01, resolved=False), *path_tracer(1, 64)])[0]
    assert entry["sentence"] == (
        "Model 2 with 1 sample: at most 1 % at 5 ms; Cycles needs at least 10 min 40 s for the same error,"
        " extrapolated: 130\u202f000×."
    )


def test_the_sentence_names_who_traced():
    points = [point("model_3", 1, 5.0, 0.4, taps=4), point("mesograin-referee", 4, 400.0, 0.4)]
    assert curve.summary(points)[0]["sentence"] == (
        "Model 3 with 1 sample of 4 taps: 40 % at 5 ms; mesograin-referee is as near after 400 ms or less."
    )


def test_a_noisy_reference_judges_in_blocks():
    metrics = {"relative_l1_corrected": 0.3, "relative_l1_blocks_corrected": 0.02}
    placed = curve.place(metrics, {"relative_l1": 0.5, "relative_l1_blocks": 0.01}, "relative_l1_blocks")
    assert placed == {"error": 0.02, "resolved": True}


def test_every_reference_of_compare_can_be_measured_against():
    assert arguments.REFERENCES == room("studies.comparison.arguments").REFERENCES
    assert arguments.parse(["--reference", "volume_dielectric"]).reference_samples == 1024
    assert arguments.parse(["--reference", "photon"]).models == ("model_1", "model_2", "model_3", "transport")


def test_defaults_suit_each_other():
    chosen = arguments.parse([])
    assert chosen.models == ("model_1", "model_2", "model_3", "transport")
    assert chosen.traced_samples == (1, 2, 4, 8, 16, 32, 64, 128)
    assert arguments.parse(["--reference", "glossy", "--reference-samples", "1"]).traced_samples == (1,)


@pytest.mark.parametrize("words, part", [
    (["--models", "lambert"], "not answered by volume_index_matched; allowed are model_1, model_2, model_3"),
    (["--traced-samples", "600"], "must not exceed the converged render's 512 samples; got 600"),
    (["--samples", "0"], "a whole number from 1 to"),
    (["--reference", "photons"], "invalid choice: 'photons'"),
    (["none.blend"], "there is no scene 'none.blend'"),
])
def test_what_is_wrong_is_one_sentence(words, part, capsys):
    with pytest.raises(SystemExit) as left:
        arguments.parse(words)
    complaint = capsys.readouterr().err
    assert left.value.code == 2 and part in complaint and complaint.count("\n") == 1


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("trade")
    (folder / "pictures").mkdir()
    points = [
        point("model_1", 1, 2.0, 0.1),
        point("model_3", 4, 12.0, 0.06, taps=16),
        point("model_3", 16, 48.0, 0.02, taps=16, resolved=False),
        *path_tracer(1, 4, 16),
    ]
    pixels = np.ones((16, 16, 4), np.float32)
    native.write_exr(folder / "pictures/reference.exr", pixels)
    for each in points:
        native.write_exr(folder / each["picture"], (1.0 + each["error"]) * pixels)
    results = {
        "format": reading.TRADE_FORMAT[0],
        "format_version": reading.TRADE_FORMAT[1],
        "complete": True,
        "created": "2024-01-02T03:04:05+00:00",
        "command": "./mesograin trade disc.blend --set 'g=0.1'",
        "scene": "disc.blend",
        "size": [16, 16],
        "versions": {"mesograin": "0.1.0", "blender": "3.4.1 (abc)", "python": "3.11", "numpy": "1.24"},
        "device": {"renderer": "llvmpipe", "version": "4.5"},
        "cpu": {"name": "A CPU", "cores": 2, "machine": "x86_64"},
        "settings": {"pixel_filter": "box", "colour_space": "linear", "frames_timed": 25},
        "definitions": {"error": "what is left of it", "milliseconds": "how long", "front": "not beaten"},
        "material": {"Sand": {"sigma_s": [0.9] * 3, "g": 0.1}},
        "reference": {"kind": "volume_index_matched", "title": "Cycles volume", "tracer": "Cycles",
                      "judged_by": "relative_l1", "samples": 64, "seeds": [1, 2],
                      "bounces": 1024, "seconds": 3.0, "notes": [], "noise_floor": 0.05, "mask": {"pixels": 200}},
        "points": points,
        "front": [points[index]["name"] for index in curve.front(points)],
        "summary": curve.summary(points),
        **{of: [points[0]] for of in curve.SHOWN},
        "summary_shown": [curve.shown(of, points[0], points) for of in curve.SHOWN],
    }
    (folder / "trade.json").write_text(json.dumps(results))
    environment = {"PATH": "/usr/bin:/bin", "MESOGRAIN_NATIVE_DIR": str(native.__file__).rsplit("/", 1)[0]}
    done = subprocess.run([sys.executable, str(BUILDER), str(folder)], env=environment, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    return folder


def test_the_page_holds_sentences_points_and_definitions(folder):
    page = (folder / "report.html").read_text()
    text = " ".join(html.unescape(re.sub(r"<[^>]*>", " ", page)).split())
    results = json.loads((folder / "trade.json").read_text())
    for entry in (*results["summary"], *results["summary_shown"]):
        assert entry["sentence"] in text
    assert all(told in text for told in curve.SHOWN.values())
    assert "./mesograin trade disc.blend --set 'g=0.1'" in text and "≤ 2.00 %" in text
    table = page[page.index("<tbody>"):page.index("</tbody>")]
    assert table.count("<tr") == len(results["points"]) and table.count('class="front"') == len(results["front"])
    for name in re.findall(r'popovertarget="([^"]+)"', page):
        assert f'popover id="{name}"' in page
    for source in re.findall(r'(?:src|href)="([^"#][^"]*)"', page):
        assert source.startswith("data:image/png;base64,") or source == "trade.csv" or (folder / source).is_file()


def test_the_plot_is_a_file_too_and_names_everything(folder):
    svg = (folder / "plots/trade.svg").read_text()
    for words in ("Model 1", "Model 3, 16 taps", "Cycles", "Pareto front", "noise floor of the converged render",
                  "time of a picture", "error: relative L1"):
        assert words in svg
    assert (folder / "plots/trade.png").read_bytes()[:4] == b"\x89PNG"


def test_numbers_at_points_that_lie_close_cover_nothing():
    points = [point("model_3", 4 ** number, 3.0 * 4 ** number * factor, 0.02 + 0.001 * taps / 16, taps=taps)
              for number in range(4) for taps, factor in ((4, 1.0), (16, 1.1), (64, 3.7))] + path_tracer(1, 4, 16)
    results = {"points": points, "front": [points[0]["name"]], "summary": curve.summary(points),
               "reference": {"judged_by": "relative_l1", "noise_floor": 0.01}}
    figure = trade_plot.trade(results)(plots._PAGE)
    figure.canvas.draw()
    [axes] = figure.axes
    boxes = [text.get_window_extent() for text in axes.texts if text.get_text()]
    assert 8 <= len(boxes) <= len(points), "most have a number, and not all have room for one"
    for number, box in enumerate(boxes):
        assert not box.count_overlaps(boxes[:number] + boxes[number + 1:])


def test_a_wrong_option_is_told_by_the_command_that_was_called(capsys):
    with pytest.raises(SystemExit) as ended:
        arguments.parse(["--nothing"])
    assert ended.value.code == 2
    assert capsys.readouterr().err.startswith("trade: ")

# What an artist reads in another language: Blender shows what a language file says, until the add-on is gone.
import json
import pathlib

import bpy
import mesograin
import pytest
from mesograin import translations
from mesograin.schema import models
from mesograin.translations import messages
from mesograin.ui import grain_colours, panels

from test_panels import draw, width

FOLDER = pathlib.Path(translations.__file__).parent
LANGUAGES = sorted(path.stem for path in FOLDER.glob("*.json"))
LABEL = 71  # pixels, as in test_panels


def said(language):
    return json.loads((FOLDER / f"{language}.json").read_text(encoding="utf-8"))


@pytest.fixture
def german():
    view = bpy.context.preferences.view
    before = view.language, view.use_translate_interface
    view.language, view.use_translate_interface = "de_DE", True
    yield bpy.app.translations.pgettext_iface
    view.language, view.use_translate_interface = before


def test_blender_shows_german_until_the_add_on_is_gone(german):
    for context in ("*", "Operator"):
        assert german("Grain from Cycles Nodes", context) == "Korn aus Cycles-Nodes"
    assert german("Transport: the mesh itself") == "Transport: das Mesh selbst"
    mesograin.unregister()
    assert german("Grain from Cycles Nodes", "Operator") == "Grain from Cycles Nodes"
    mesograin.register()
    assert german("Grain from Cycles Nodes", "Operator") == "Korn aus Cycles-Nodes"


def test_english_stays_english():
    assert bpy.app.translations.pgettext_iface("Grain from Cycles Nodes", "Operator") == "Grain from Cycles Nodes"


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_language_says_all_labels_and_nothing_that_is_not_there(language):
    known = said(language)
    assert language in bpy.app.translations.locales
    assert [label for label in messages.labels() if label not in known] == []
    source = "\n".join(path.read_text(encoding="utf-8") for path in FOLDER.parent.glob("ui/**/*.py"))
    asked = {*messages.labels(), *messages.tooltips(), *(f"{name} R" for name in ("sigma_s", "sigma_a", "Path"))}
    assert [text for text in known if text not in asked and f'"{text}"' not in source] == []


@pytest.mark.parametrize("way", ["coefficients", "look"])
@pytest.mark.parametrize("model", models.CHOICES)
def test_the_grain_panel_is_german_and_fits(german, native, model, way):
    material, known = bpy.data.materials.new("Sand"), said("de_DE")
    material.mesograin.model, material.mesograin_look.way = model, way
    drawn = draw(panels.MESOGRAIN_PT_material, material=material)
    drawn.labels += draw(grain_colours.MESOGRAIN_PT_colours, material=material).labels
    texts = [text for text in (*drawn.labels, *drawn.boxes) if text not in ("G", "B")]  # channels
    assert len(texts) > 3 and [text for text in texts if text not in known] == []
    assert {text: german(text) for text in texts if width(german(text)) > LABEL} == {}


def test_what_there_is_to_translate_is_found():
    labels, tooltips = messages.labels(), messages.tooltips()
    assert {"Grain", "Copy Grain", "Half space", "Vary Grains"} <= set(labels) and len(labels) > 120
    assert len(tooltips) > 100 and not set(labels) & set(tooltips)

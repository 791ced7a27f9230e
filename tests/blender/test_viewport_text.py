# What is said over a viewport fits beside what else lies there.
import types

import pytest

from mesograin.engine import viewport_text

SENTENCE = "Material 'Brick' is no grain and is drawn as a diffuse surface under a coat; left out: its texture."


def test_a_sentence_that_fits_is_said_as_it_is():
    assert viewport_text.line([SENTENCE], len(SENTENCE)) == SENTENCE


@pytest.mark.parametrize("others", [(), ("One more.",), ("One more.", "And another.")])
@pytest.mark.parametrize("fitting", [70, 80, 90])
def test_a_sentence_that_does_not_fit_says_where_all_of_it_is(others, fitting):
    said = viewport_text.line([SENTENCE, *others], fitting)
    assert len(said) <= fitting
    assert said.startswith("Material 'Brick'") and "…" in said and viewport_text.PLACE in said
    assert not others or f"and {len(others)} more" in said


def region(kind, x, width, alignment="NONE"):
    return types.SimpleNamespace(type=kind, x=x, width=width, alignment=alignment)


def context(*others, gizmo=False):
    window = region("WINDOW", 100, 600)
    return types.SimpleNamespace(
        region=window, area=types.SimpleNamespace(regions=[window, *others]),
        preferences=types.SimpleNamespace(system=types.SimpleNamespace(ui_scale=1.0)),
        space_data=types.SimpleNamespace(show_gizmo=gizmo, show_gizmo_navigate=True))


def test_toolbar_sidebar_and_gizmo_leave_less_room():
    bare = viewport_text.columns(context())
    assert bare == pytest.approx(600 / viewport_text.CHARACTER, abs=1)
    toolbar, sidebar = region("TOOLS", 100, 60, "LEFT"), region("UI", 500, 200, "RIGHT")
    assert viewport_text.columns(context(toolbar)) == pytest.approx(bare * 0.9, abs=1)
    assert viewport_text.columns(context(toolbar, sidebar)) == pytest.approx(bare * 340 / 600, abs=1)
    assert viewport_text.columns(context(gizmo=True)) < bare
    # Hidden ones, and those of areas elsewhere, take nothing.
    assert viewport_text.columns(context(region("UI", 500, 1, "RIGHT"), region("TOOLS", 900, 60, "LEFT"))) == bare

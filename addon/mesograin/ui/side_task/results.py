# How a comparison's result is shown in a panel: its numbers, the verdict, a button for each picture.
from ...durations import duration
from ...schema import labels
from ...schema.models import CHOICES
from ...studies.comparison.significance import NO_DIFFERENCE
from ...studies.comparison.verdict import verdict
from .. import panels
from . import pictures


def draw_title(box, context, entry):
    """What was compared, and by which boundary if it is not the materials' own."""
    replaced = f", boundary {labels.boundary(entry)}" if entry.get("own_boundaries") else ""
    panels.draw_sentence(
        box, context, f"{CHOICES[entry['model']].label} against {entry['reference_title']}{replaced}", icon="NONE")


def draw(box, context, entry, ours, button, **properties):
    """entry: as a case of results.json, `name` and `files` included. ours: (title, text), what our side took.
    button: the operator that shows a picture, with `properties`."""
    draw_title(box, context, entry)
    grid = box.grid_flow(row_major=True, columns=2, even_columns=True, align=True)
    for title, value in _numbers(entry, ours):
        grid.label(text=title)
        grid.label(text=value)
    test = entry["significance"]
    same = test is not None and test["verdict"] == NO_DIFFERENCE
    words = verdict(entry)
    panels.draw_sentence(box, context, words[:1].upper() + words[1:], icon="CHECKMARK" if same else "INFO")
    shown = pictures.pictures_of(entry)
    above = (len(shown) + 1) // 2  # all of them in one row are too narrow for their names
    rows = box.column(align=True)
    for part in (shown[:above], shown[above:]):
        row = rows.row(align=True)
        for picture in part:
            made = row.operator(button.bl_idname, text=pictures.BUTTONS[picture][0])
            made.picture = picture
            for name, value in properties.items():
                setattr(made, name, value)


def seconds(number):
    """'870 ms', '41 s', '3 min 05 s'."""
    return duration(number) if number >= 1.0 else f"{1000.0 * number:.0f} ms"


def _numbers(entry, ours):
    """(title, value) pairs. The definitions are in the file of the results."""
    # Short enough for half a panel of Blender's default width.
    metrics = entry["metrics"]
    off = metrics["relative_l1_blocks_corrected"]
    yield "Off in Blocks", _share(metrics["relative_l1_blocks"] if off is None else off)
    yield "Relative L1", _share(metrics["relative_l1"])
    yield "Noise Floor", _share(entry["noise_floor"]["relative_l1"])
    yield ours
    yield "Cycles", seconds(entry["reference_seconds"])


def _share(value):
    return "none" if value is None else f"{value:.2%}"

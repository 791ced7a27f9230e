# What the tutorial prints in italics is what Blender shows.
import pathlib
import re

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
TEXT = (ROOT / "docs/tutorial.md").read_text()
ADDON = "".join(path.read_text() for path in sorted((ROOT / "addon/mesograin").rglob("*"))
                if path.suffix in (".py", ".json"))
# Blender's own.
BLENDER = {"File", "New", "General", "Render Engine", "Rendered", "Bevel", "Shade Auto Smooth", "Sun", "Angle", "Add",
           "Mesh", "Plane"}
WORDS = sorted(set(re.findall(r"\*([^*\n]+)\*", TEXT)) - BLENDER - {"italics"})


@pytest.mark.parametrize("words", WORDS)
def test_the_add_on_says_so_too(words):
    assert re.search(rf'["\']{re.escape(words)}["\']', ADDON) or f'"{words.lower()}"' in ADDON


def test_every_picture_is_there():
    for picture in re.findall(r"\]\((images/[^)]+)\)", TEXT):
        assert (ROOT / "docs" / picture).stat().st_size > 1000, picture

"""What every file keeps to: it opens with what it is for, holds no leftovers, and names no one's machine."""
import re

import pytest

from sources import SOURCE, source_files

COMMENT = {".cpp": "//", ".h": "//", ".glsl": "//", ".vert": "//", ".tesc": "//", ".tese": "//", ".frag": "//",
           ".comp": "//", ".sh": "#", ".txt": "#", ".cmake": "#"}
TEXT = (".cpp", ".h", ".glsl", ".vert", ".tesc", ".tese", ".frag", ".comp", ".py", ".sh", ".txt", ".cmake", ".md",
        ".html", ".css", ".js", ".json", ".toml", "mesograin", ".ci/run")
LEFTOVER = re.compile(r"\b(TODO|FIXME|XXX|HACK)\b|^(<<<<<<<|>>>>>>>)", re.MULTILINE)
SOMEONES_FOLDER = re.compile(r"(?<![\w.}])/(root|home|work|Users)/\w")
DATA_LIMIT = 6 * 2**20  # bytes that a clone has to carry for the tests


def opening(text):
    """The first line that is not a #!, #version, #pragma once or empty."""
    lines = [line.strip() for line in text.splitlines() if not line.startswith(("#!", "#version", "#pragma once"))]
    return next((line for line in lines if line), "")


def must_open_with_its_purpose(path):
    """A room's list of its own files says nothing that the room's name does not."""
    return not path.startswith("tests/data/") and (path == "CMakeLists.txt" or not path.endswith("/CMakeLists.txt"))


@pytest.mark.parametrize("path", filter(must_open_with_its_purpose, source_files(*COMMENT, ".py")))
def test_opens_with_its_purpose(path):
    first = opening((SOURCE / path).read_text())
    if path.endswith(".py"):
        assert re.match(r'r?"""\S|#', first), f"opens with {first!r}, not with a docstring or comment"
    else:
        comment = COMMENT[path[path.rindex("."):]]
        assert first.startswith(comment), f"opens with {first!r}, not with a comment"


@pytest.mark.parametrize("path", source_files(*TEXT))
def test_is_tidy(path):
    text = (SOURCE / path).read_text()
    assert "\r" not in text, "has carriage returns"
    assert not text or text.endswith("\n"), "does not end in a newline"
    spaces = [number for number, line in enumerate(text.splitlines(), 1) if line != line.rstrip()]
    assert not spaces, f"has spaces at the end of lines {spaces}"
    if path != "tests/lint/test_hygiene.py":
        found = LEFTOVER.search(text) or SOMEONES_FOLDER.search(text)
        assert not found, f"holds {found.group()!r}"


def test_test_data_is_small():
    total = sum((SOURCE / path).stat().st_size for path in source_files("") if path.startswith("tests/data/"))
    assert total < DATA_LIMIT

"""C++ and shaders are formatted as the .clang-format nearest to them says."""
import os
import subprocess

import pytest

from sources import SOURCE, source_files

SHADERS = [path for path in source_files(".glsl", ".frag", ".vert", ".tesc", ".tese", ".comp")
           if path.startswith("shaders/")]


@pytest.mark.parametrize("path", source_files(".cpp", ".h"))
def test_clang_format(path):
    outcome = subprocess.run(["clang-format-14", "--dry-run", "--Werror", path], cwd=SOURCE, capture_output=True,
                             text=True)
    assert outcome.returncode == 0, outcome.stderr


@pytest.mark.parametrize("path", SHADERS)
def test_clang_format_of_a_shader(path):
    # Of which clang-format knows no ending: it is told a name that stands for C++, in the same folder.
    with open(SOURCE / path, encoding="utf-8") as text:
        outcome = subprocess.run(["clang-format-14", "--dry-run", "--Werror",
                                  f"--assume-filename={os.path.splitext(path)[0]}.cpp"], cwd=SOURCE, stdin=text,
                                 capture_output=True, text=True)
    assert outcome.returncode == 0, outcome.stderr

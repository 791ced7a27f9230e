"""C++ is formatted as .clang-format says."""
import subprocess

import pytest

from sources import SOURCE, source_files


@pytest.mark.parametrize("path", source_files(".cpp", ".h"))
def test_clang_format(path):
    outcome = subprocess.run(["clang-format-14", "--dry-run", "--Werror", path], cwd=SOURCE, capture_output=True,
                             text=True)
    assert outcome.returncode == 0, outcome.stderr

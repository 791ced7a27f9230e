"""Python holds under flake8 with the settings of .flake8."""
import subprocess
import sys

import pytest

from sources import SOURCE, source_files


@pytest.mark.parametrize("path", source_files(".py"))
def test_flake8(path):
    outcome = subprocess.run([sys.executable, "-m", "flake8", path], cwd=SOURCE, capture_output=True, text=True)
    assert outcome.returncode == 0, outcome.stdout + outcome.stderr

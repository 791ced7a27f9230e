"""The shell scripts hold under shellcheck; the launcher and what it sources are one program."""
import subprocess

import pytest

from sources import SOURCE


@pytest.mark.parametrize("script", ["mesograin", ".ci/run"])
def test_shellcheck(script):
    outcome = subprocess.run(["shellcheck", script], cwd=SOURCE, capture_output=True, text=True)
    assert outcome.returncode == 0, outcome.stdout

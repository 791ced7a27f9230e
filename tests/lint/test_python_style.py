"""Python holds under flake8 with the settings of .flake8."""
import collections
import subprocess
import sys

import pytest

from sources import SOURCE, source_files

FILES = source_files(".py")


@pytest.fixture(scope="module")
def complaints():
    """{path: what flake8 says of it}; one run for all, which starts once and takes every core."""
    outcome = subprocess.run([sys.executable, "-m", "flake8", *FILES], cwd=SOURCE, capture_output=True, text=True)
    assert outcome.returncode in (0, 1) and not outcome.stderr, outcome.stderr
    found = collections.defaultdict(list)
    for line in outcome.stdout.splitlines():
        found[line.split(":", 1)[0]].append(line)
    assert bool(found) == (outcome.returncode == 1) and found.keys() <= set(FILES), outcome.stdout
    return found


@pytest.mark.parametrize("path", FILES)
def test_flake8(path, complaints):
    assert not complaints[path], "\n".join(complaints[path])

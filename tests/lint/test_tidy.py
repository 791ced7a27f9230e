"""C++ holds under clang-tidy with the checks of .clang-tidy; what passed once is not checked again until it changes."""
import concurrent.futures
import hashlib
import os
import pathlib
import subprocess

import pytest

from sources import SOURCE, source_files

BUILD = pathlib.Path(os.environ.get("MESOGRAIN_BUILD", SOURCE / "build/release"))
FILES = source_files(".cpp")


def fingerprint(path):
    """Changes with the file, with any header and with the checks; says nothing about who includes whom."""
    digest = hashlib.sha256((SOURCE / path).read_bytes())
    for other in [".clang-tidy"] + source_files(".h", ".glsl"):
        digest.update((SOURCE / other).read_bytes())
    return digest.hexdigest()


def check(path):
    passed = BUILD / "tidy" / fingerprint(path)
    if passed.exists():
        return ""
    outcome = subprocess.run(["clang-tidy-14", "--quiet", "-p", str(BUILD), path], cwd=SOURCE, capture_output=True,
                             text=True)
    if outcome.returncode == 0:
        passed.parent.mkdir(exist_ok=True)
        passed.touch()
        return ""
    return outcome.stdout or outcome.stderr


@pytest.fixture(scope="module")
def complaints():
    """What clang-tidy says of each file; all cores at work."""
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return dict(zip(FILES, pool.map(check, FILES)))


@pytest.mark.parametrize("path", FILES)
def test_clang_tidy(path, complaints):
    assert not complaints[path], complaints[path]

"""C++ holds under clang-tidy with the checks of .clang-tidy.

What passed once, in whichever checkout, is not checked again until something changes that it depends on: its text, the
project's headers that it includes, how it is compiled, the checks, or clang-tidy itself.
"""
import concurrent.futures
import functools
import hashlib
import json
import os
import pathlib
import subprocess

import pytest

from sources import SOURCE, source_files

BUILD = pathlib.Path(os.environ.get("MESOGRAIN_BUILD", SOURCE / "build/release"))
PASSED = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache") / "mesograin/tidy"
TIDY = "clang-tidy-14"
FILES = source_files(".cpp")


@functools.cache
def compile_commands():
    """{path relative to the source folder: the command that compiles it, without the folders' names}."""
    entries = json.loads((BUILD / "compile_commands.json").read_text())
    return {os.path.relpath(entry["file"], SOURCE):
            entry["command"].replace(str(BUILD), "BUILD").replace(str(SOURCE), "SOURCE") for entry in entries}


@functools.cache
def included():
    """{path: the project's own files that its last build read}, relative to the source folder."""
    listed = subprocess.run(["ninja", "-C", str(BUILD), "-t", "deps"], capture_output=True, text=True,
                            check=True).stdout
    found = {}
    for block in listed.split("\n\n"):
        paths = [os.path.normpath(BUILD / line.strip()) for line in block.splitlines()[1:]]
        own = [os.path.relpath(path, SOURCE) for path in paths if path.startswith(f"{SOURCE}{os.sep}")]
        if own:
            found[own[0]] = sorted(own)
    return found


@functools.cache
def digest_of(path):
    return hashlib.sha256((SOURCE / path).read_bytes()).hexdigest()


@functools.cache
def version():
    return subprocess.run([TIDY, "--version"], capture_output=True, text=True, check=True).stdout


def fingerprint(path):
    """None for a file that the build does not know: it is checked each time."""
    if path not in included() or path not in compile_commands():
        return None
    own = [path for path in included()[path] if (SOURCE / path).is_file()]
    parts = [version(), digest_of(".clang-tidy"), compile_commands()[path],
             *(f"{path} {digest_of(path)}" for path in own)]
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()


def check(path):
    key = fingerprint(path)
    if key and (PASSED / key).exists():
        return ""
    outcome = subprocess.run([TIDY, "--quiet", "-p", str(BUILD), path], cwd=SOURCE, capture_output=True, text=True)
    if outcome.returncode:
        return outcome.stdout or outcome.stderr
    if key:
        PASSED.mkdir(parents=True, exist_ok=True)
        (PASSED / key).touch()
    return ""


@pytest.fixture(scope="module")
def complaints():
    """What clang-tidy says of each file; all cores at work."""
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return dict(zip(FILES, pool.map(check, FILES)))


@pytest.mark.parametrize("path", FILES)
def test_clang_tidy(path, complaints):
    assert not complaints[path], complaints[path]

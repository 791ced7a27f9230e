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
import re
import subprocess

import pytest

from sources import SOURCE, source_files

BUILD = pathlib.Path(os.environ.get("MESOGRAIN_BUILD", SOURCE / "build/release"))
PASSED = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache") / "mesograin/tidy"
TIDY = "clang-tidy-14"
FILES = source_files(".cpp")


@functools.cache
def compile_commands():
    """{path relative to the source folder: how that file is compiled by itself}. The build compiles some together, as
    a text that includes them."""
    found = {}
    for entry in json.loads((BUILD / "compile_commands.json").read_text()):
        together = entry["file"]
        text = pathlib.Path(together).read_text() if "/Unity/" in together else f'#include "{together}"'
        for path in re.findall('#include "(.*)"', text):
            command = re.sub(r" -o \S+", "", entry["command"]).replace(f"-c {together}", f"-c {path}")
            found[os.path.relpath(path, SOURCE)] = command
    return found


@pytest.fixture(scope="module")
def database(tmp_path_factory):
    """A folder with the compile commands, as clang-tidy wants them."""
    folder = tmp_path_factory.mktemp("tidy")
    (folder / "compile_commands.json").write_text(json.dumps([
        {"directory": str(BUILD), "command": command, "file": str(SOURCE / path)}
        for path, command in compile_commands().items()]))
    return folder


@functools.cache
def included():
    """{path: it and the project's headers that the build read with it or beside it, relative to the source folder}."""
    listed = subprocess.run(["ninja", "-C", str(BUILD), "-t", "deps"], capture_output=True, text=True,
                            check=True).stdout
    found = {}
    for block in listed.split("\n\n"):
        paths = [os.path.normpath(BUILD / line.strip()) for line in block.splitlines()[1:]]
        own = sorted(os.path.relpath(path, SOURCE) for path in paths if path.startswith(f"{SOURCE}{os.sep}"))
        headers = [path for path in own if not path.endswith((".cpp", ".cxx"))]
        found.update({path: [path, *headers] for path in own if path.endswith(".cpp")})
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
    command = compile_commands()[path].replace(str(BUILD), "BUILD").replace(str(SOURCE), "SOURCE")
    parts = [version(), digest_of(".clang-tidy"), command,
             *(f"{path} {digest_of(path)}" for path in own)]
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()


def check(path, database):
    key = fingerprint(path)
    if key and (PASSED / key).exists():
        return ""
    outcome = subprocess.run([TIDY, "--quiet", "-p", str(database), path], cwd=SOURCE, capture_output=True, text=True)
    if outcome.returncode:
        return outcome.stdout or outcome.stderr
    if key:
        PASSED.mkdir(parents=True, exist_ok=True)
        (PASSED / key).touch()
    return ""


@pytest.fixture(scope="module")
def complaints(database):
    """What clang-tidy says of each file; all cores at work."""
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return dict(zip(FILES, pool.map(lambda path: check(path, database), FILES)))


@pytest.mark.parametrize("path", FILES)
def test_clang_tidy(path, complaints):
    assert not complaints[path], complaints[path]

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
MAIN_FILE_ONLY = "misc-unused-alias-decls,misc-unused-using-decls,readability-redundant-preprocessor"


@functools.cache
def compile_commands():
    """{text that the build compiles, absolute path: how}. A text is a file, or one that includes some of a folder."""
    return {entry["file"]: re.sub(r" -o \S+", "", entry["command"])
            for entry in json.loads((BUILD / "compile_commands.json").read_text())}


@functools.cache
def text_of():
    """{path relative to the source folder: the text that the build compiles it in}. Checked as they are compiled,
    together, files cost a fifth: most of the time goes into the headers that they share."""
    found = {}
    for text in compile_commands():
        paths = re.findall('#include "(.*)"', pathlib.Path(text).read_text()) if "/Unity/" in text else [text]
        found.update({os.path.relpath(path, SOURCE): text for path in paths})
    return found


@pytest.fixture(scope="module")
def database(tmp_path_factory):
    """A folder with the compile commands, as clang-tidy wants them: of what the build compiles, and of each file by
    itself."""
    commands = dict(compile_commands())
    for path, text in text_of().items():
        commands[str(SOURCE / path)] = compile_commands()[text].replace(f"-c {text}", f"-c {SOURCE / path}")
    folder = tmp_path_factory.mktemp("tidy")
    (folder / "compile_commands.json").write_text(json.dumps([
        {"directory": str(BUILD), "command": command, "file": path} for path, command in commands.items()]))
    return folder


@functools.cache
def included():
    """{text: the project's files that the build read with it, relative to the source folder}."""
    listed = subprocess.run(["ninja", "-C", str(BUILD), "-t", "deps"], capture_output=True, text=True,
                            check=True).stdout
    text_of_name = {os.path.normpath(text): text for text in compile_commands()}
    found = {}
    for block in listed.split("\n\n"):
        paths = [os.path.normpath(BUILD / line.strip()) for line in block.splitlines()[1:]]
        own = sorted(os.path.relpath(path, SOURCE) for path in paths if path.startswith(f"{SOURCE}{os.sep}"))
        for path in paths:
            if path in text_of_name:
                found[text_of_name[path]] = [path for path in own if (SOURCE / path).is_file()]
    return found


@functools.cache
def digest_of(path):
    return hashlib.sha256((SOURCE / path).read_bytes()).hexdigest()


@functools.cache
def version():
    return subprocess.run([TIDY, "--version"], capture_output=True, text=True, check=True).stdout


def fingerprint(text):
    """None for a text that the build did not compile yet: it is checked each time."""
    if text not in included():
        return None
    command = compile_commands()[text].replace(str(BUILD), "BUILD").replace(str(SOURCE), "SOURCE")
    parts = [version(), digest_of(".clang-tidy"), digest_of("tests/lint/test_tidy.py"), command,
             *(f"{path} {digest_of(path)}" for path in included()[text] if not path.startswith(f"build{os.sep}")),
             *sorted(path for path, its in text_of().items() if its == text)]
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()


def tidy(path, database, checks):
    outcome = subprocess.run([TIDY, "--quiet", "-p", str(database), f"--checks={checks}", str(path)], cwd=SOURCE,
                             capture_output=True, text=True)
    return (outcome.stdout or outcome.stderr) if outcome.returncode else ""


def alone(text):
    """The files of a text that must be looked at by themselves too: three checks look at the main file only, or at
    what is said anywhere in it."""
    return [path for path, its in text_of().items()
            if its == text and path in FILES and path != os.path.relpath(text, SOURCE)
            and re.search(r"^\s*(#\s*if|namespace \w+ =|using [\w:]+;)", (SOURCE / path).read_text(), re.MULTILINE)]


def check(text, database):
    """What clang-tidy says of what the build compiles as one text."""
    key = fingerprint(text)
    if key and (PASSED / key).exists():
        return ""
    complaint = tidy(text, database, "-bugprone-suspicious-include" if "/Unity/" in text else "")
    complaint += "".join(tidy(SOURCE / path, database, f"-*,{MAIN_FILE_ONLY}") for path in alone(text))
    if key and not complaint:
        PASSED.mkdir(parents=True, exist_ok=True)
        (PASSED / key).touch()
    return complaint


@pytest.fixture(scope="module")
def complaints(database):
    """{text: what clang-tidy says of it}; all cores at work."""
    texts = sorted(set(text_of().values()))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return dict(zip(texts, pool.map(lambda text: check(text, database), texts)))


@pytest.mark.parametrize("path", FILES)
def test_clang_tidy(path, complaints):
    assert path in text_of(), "the build does not compile this file"
    complaint = complaints[text_of()[path]]
    blamed = [each for each, text in text_of().items() if text == text_of()[path] and str(SOURCE / each) in complaint]
    assert not complaint or (blamed and path not in blamed), complaint


def test_a_file_compiled_with_others_is_looked_at(tmp_path):
    """What is wrong in a file is found in a text that includes it."""
    wrong = tmp_path / "tests/wrong.cpp"
    wrong.parent.mkdir()
    wrong.write_text("int* wrong = 0;\n")
    text = tmp_path / "text.cxx"
    text.write_text(f'#include "{wrong}"\n')
    said = subprocess.run([TIDY, "--quiet", f"--config-file={SOURCE / '.clang-tidy'}", str(text), "--"],
                          capture_output=True, text=True).stdout
    assert "wrong.cpp:1:14" in said and "modernize-use-nullptr" in said

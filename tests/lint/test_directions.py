"""Rooms import as docs/architecture.md says: its first block is read, and every #include and import held against it."""
import ast
import re

import pytest

from sources import SOURCE, source_files

BLOCK = re.search(r"## Rooms.*?```\n(.*?)```", (SOURCE / "docs/architecture.md").read_text(), re.DOTALL).group(1)
INCLUDE = re.compile(r'^#include "([a-z_0-9]+)/(?:([a-z_0-9]+)/)?', re.MULTILINE)
PACKAGE = "addon/mesograin/"
NATIVE_FILES = [path for path in source_files(".cpp", ".h") if path.startswith("native/")]
SHADER_FILES = [path for path in source_files(".glsl", ".frag", ".vert", ".tesc", ".tese", ".comp")
                if path.startswith("shaders/")]
ADDON_FILES = [path for path in source_files(".py") if path.startswith(PACKAGE)]


def chain(heading):
    """The names of the line `a < b < c`, however many lines it takes, under a heading."""
    lines = BLOCK.splitlines()
    below = lines[lines.index(heading) + 1:]
    end = next((number for number, line in enumerate(below) if not line.startswith("  ")), len(below))
    return [name.strip() for name in " ".join(below[:end]).split("<")]


def known_by_native_rooms():
    """{room: the rooms that it may include, those that they know among them}."""
    known = {}
    for room, words in re.findall(r"^native/(\w+) .*?knows (.+)$", BLOCK, re.MULTILINE):
        if words.startswith("all of the above"):
            named = set(known) - set(re.findall(r"but (\w+)", words))
        else:
            named = set(words.split(", ")) - {"nobody"}
        known[room] = {room} | named | set().union(*(known[name] for name in named))
    return known


NATIVE = known_by_native_rooms()
PHYSICS = chain("folders of native/physics")
SHADERS = chain("shaders")
ADDON = {heading.removeprefix("addon/mesograin").strip("/"): chain(heading)
         for heading in re.findall(r"^addon/mesograin\S*$", BLOCK, re.MULTILINE)}
"""{room, "" for the package itself: what stands right under it, in order}."""


def test_every_room_stands_in_the_plan():
    assert {path.split("/")[1] for path in NATIVE_FILES} == set(NATIVE)
    assert {path.split("/")[1] for path in SHADER_FILES} == set(SHADERS)
    for room, names in ADDON.items():
        under = [path for path in ADDON_FILES if path.startswith(f"{PACKAGE}{room}/" if room else PACKAGE)]
        assert {module_of(path, room) for path in under} - {"__init__"} == set(names), room


@pytest.mark.parametrize("path", NATIVE_FILES)
def test_a_native_room_includes_what_it_knows(path):
    parts = path.split("/")
    for room, folder in INCLUDE.findall((SOURCE / path).read_text()):
        assert room in NATIVE[parts[1]], f"native/{parts[1]} does not know {room}"
        if parts[1] == room == "physics":
            of = PHYSICS.index(parts[2]) if parts[2] in PHYSICS else -1
            assert folder not in PHYSICS or PHYSICS.index(folder) <= of, f"{path} stands below {folder}"


@pytest.mark.parametrize("path", SHADER_FILES)
def test_a_shader_includes_what_stands_before_it(path):
    own = SHADERS.index(path.split("/")[1])
    for room, _ in INCLUDE.findall((SOURCE / path).read_text()):
        assert SHADERS.index(room) <= own, f"{path} does not know {room}"


def module_of(path, room=""):
    """What a file is of right under the package or a room of it: a room, or a module alone."""
    return path.removeprefix(f"{PACKAGE}{room}/" if room else PACKAGE).removesuffix(".py").split("/")[0]


def imported(path):
    """The modules of the package that a file imports, at its head or inside a function, as lists of names under it."""
    package = path.removeprefix("addon/").split("/")[:-1]
    for node in ast.walk(ast.parse((SOURCE / path).read_text())):
        if isinstance(node, ast.ImportFrom):
            base = package[:len(package) - node.level + 1] if node.level else []
            module = base + (node.module.split(".") if node.module else [])
            targets = [[*module, alias.name] for alias in node.names]
        elif isinstance(node, ast.Import):
            targets = [alias.name.split(".") for alias in node.names]
        else:
            continue
        yield from (target[1:] for target in targets if target[0] == "mesograin" and len(target) > 1)


def hold(order, name, other):
    assert other not in order or order.index(other) <= order.index(name), f"{name} does not know {other}"


@pytest.mark.parametrize("path", ADDON_FILES)
def test_a_module_of_the_addon_imports_what_stands_before_it(path):
    own = module_of(path)
    if own == "__init__":  # the package itself registers everything
        return
    for module in imported(path):
        hold(ADDON[""], own, module[0])
        if module[0] == own in ADDON and len(module) > 1 and path != f"{PACKAGE}{own}/__init__.py":
            hold(ADDON[own], module_of(path, own), module[1])

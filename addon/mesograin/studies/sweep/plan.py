# Reads a sweep's TOML file and unfolds it into cases.
"""See `read`. The file's form is in docs/sweeps.md."""
import functools
import hashlib
import itertools
import json
import math
import re
import tomllib
from dataclasses import dataclass
from pathlib import Path

from ...cycles.kinds import KINDS, PARTS, default_kind, has, missing_part
from ...schema.parameters import PARAMETERS, SCENE, SETTABLE

MODELS = tuple(dict.fromkeys(model for kind in KINDS.values() for model in kind.models))
REFERENCES = tuple(KINDS)


class PlanError(Exception):
    """The file cannot be swept: one sentence that names the line and what is allowed."""


@dataclass(frozen=True)
class Whole:
    """A whole number in [low, high]."""

    low: int
    high: int

    def check(self, value):
        return (
            value
            if isinstance(value, int) and not isinstance(value, bool) and self.low <= value <= self.high
            else None
        )

    def __str__(self):
        return f"a whole number from {self.low} to {self.high}"


@dataclass(frozen=True)
class Choice:
    """One of some names."""

    names: tuple

    def check(self, value):
        return value if value in self.names else None

    def __str__(self):
        return "one of " + ", ".join(self.names)


@dataclass(frozen=True)
class Switch:
    """Whether or not."""

    def check(self, value):
        return value if isinstance(value, bool) else None

    def __str__(self):
        return "true or false"


SETTINGS = {
    "size": Whole(8, 16384),
    "samples": Whole(1, 1 << 20),
    "reference_samples": Whole(1, 1 << 20),
    "seeds": Whole(1, 1024),
    "part": Choice(PARTS),
    "controls": Switch(),
    "exchange": Choice(tuple(choice.name for choice in SCENE["exchange"].choices)),
}
MOST_CASES = 100_000
"""More than anyone waits for, and fewer than fill the memory."""
MOST_SHOWN = 60
"""Characters of a value in a message: a sentence stays one that can be read."""
TOP_LEVEL = ("title", "scenes", "models", "references", "material", "grid", "list", *SETTINGS)


@dataclass(frozen=True)
class Case:
    """One comparison: everything that determines it, and a name made from that.

    scene: absolute path. parameters: of the material, those that differ from the scene's. settings: size, samples, ...
    """

    scene: str
    model: str
    reference: str
    parameters: tuple
    settings: tuple
    label: str

    @functools.cached_property
    def content(self):
        """Stands for the scene's bytes as they were when first asked for: a case keeps its name while it runs."""
        return _content(self.scene)

    def scene_changed(self):
        """Whether the scene is another one by now, or gone."""
        try:
            return _content(self.scene) != self.content
        except OSError:
            return True

    @property
    def key(self):
        """Sixteen hexadecimal digits that stand for all that determines the case, the scene's content included."""
        return _digest([self.content, self.model, self.reference, self.parameters, self.settings])

    @property
    def shared(self):
        """Equal for cases that are compared with one and the same reference."""
        ours = ("samples", "exchange")
        theirs = [setting for setting in self.settings if setting[0] not in ours]
        return _digest([self.content, self.reference, self.parameters, theirs])

    def as_json(self):
        return {
            "scene": self.scene,
            "model": self.model,
            "reference": self.reference,
            "parameters": {name: value for name, value in self.parameters},
            "settings": {name: value for name, value in self.settings},
            "label": self.label,
        }


@dataclass(frozen=True)
class Plan:
    """A sweep unfolded. axes: the names of the parameters that vary, in the file's order."""

    title: str
    path: str
    axes: tuple
    cases: tuple

    @property
    def groups(self):
        """The cases' indices, those that share a reference together: whoever runs a group renders it once."""
        groups = {}
        for index, case in enumerate(self.cases):
            groups.setdefault(case.shared, []).append(index)
        return tuple(map(tuple, groups.values()))


def _digest(described):
    return hashlib.sha256(json.dumps(described).encode()).hexdigest()[:16]


def _content(scene):
    status = Path(scene).stat()
    return _content_of(scene, status.st_mtime_ns, status.st_size)


@functools.lru_cache(maxsize=None)
def _content_of(scene, _time, _size):
    """Of the scene's bytes, read again when the file's time or size says that it changed."""
    with open(scene, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def read(path):
    """Plan of the TOML file at `path`; scenes are looked for beside the file, then in the working folder.

    Raises PlanError: what is wrong, in which line, and what is allowed.
    """
    path = Path(path)
    try:
        text = path.read_text(encoding="utf-8-sig")  # some editors begin a file with a mark
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or error
        raise PlanError(f"The sweep '{path}' cannot be read ({reason}): name a TOML file.") from error
    try:
        table = tomllib.loads(text)
    except RecursionError as error:
        raise PlanError(f"The sweep '{path}' is no sweep: its lists or tables lie too deep in one another.") from error
    except ValueError as error:  # TOMLDecodeError, and what Python says of a number of thousands of digits
        raise PlanError(f"The sweep '{path}' is no TOML: {error}.") from error
    return _Reader(path, text, table).plan()


class _Reader:
    def __init__(self, path, text, table):
        self.path, self.lines, self.table = path, text.splitlines(), table

    def plan(self):
        for name in self.table:
            if name not in TOP_LEVEL:
                raise self.error((), name, f"'{name}' is not known here; allowed are {', '.join(TOP_LEVEL)}")
        scenes = [self.scene(name) for name in self.names("scenes", None)]
        pairs = self.pairs()
        settings = self.settings()
        fixed = self.parameters(("material",), self.section("material"))
        grid = self.section("grid")
        rows = self.rows()
        axes = tuple(dict.fromkeys([*grid, *(name for row in rows for name in row)]))
        points = [self.axis(name, values) for name, values in grid.items()]
        count = math.prod(map(len, [scenes, pairs, rows, *points]))
        if count > MOST_CASES:
            raise self.error((), "grid", f"there are {count} cases; at most {MOST_CASES} are allowed")

        cases = []
        for scene, (model, reference), row, *point in itertools.product(scenes, pairs, rows, *points):
            parameters = {**fixed, **row, **dict(zip(grid, point, strict=True))}
            varying = {name: parameters[name] for name in axes if name in parameters}
            label = " ".join(
                [
                    Path(scene).stem,
                    model,
                    *([reference] if len({kind for name, kind in pairs if name == model}) > 1 else []),
                    *(f"{name}={_short(value)}" for name, value in varying.items()),
                ]
            )
            cases.append(
                Case(
                    scene, model, reference, tuple(sorted(parameters.items())), tuple(sorted(settings.items())), label
                )
            )
        return Plan(str(self.table.get("title", self.path.stem)), str(self.path), axes, tuple(cases))

    def settings(self):
        """{name: value} of those that the file names; what is switched off is as good as not named."""
        named = {
            name: self.value((), name, self.table[name], kind)
            for name, kind in SETTINGS.items()
            if name in self.table
        }
        settings = {name: value for name, value in named.items() if value is not False}
        if "controls" in settings and settings.get("seeds", 2) < 2:
            raise self.error((), "controls", "controls need 2 or more seeds, since one does not tell its noise")
        return settings

    def pairs(self):
        """[(model, reference)]: each model with those of the references that answer it, or with its default one."""
        models = self.names("models", MODELS)
        part = self.value((), "part", self.table["part"], SETTINGS["part"]) if "part" in self.table else None
        if "references" not in self.table:
            for model in models:
                if not default_kind(model, part):
                    raise self.error((), "models", f"no reference has a {part} part of {model}")
            return [(model, default_kind(model, part)) for model in models]
        references = self.names("references", REFERENCES)
        for kind in references:
            if not has(kind, part):
                raise self.error((), "references", missing_part(kind, part))
        for model in models:
            if not any(model in KINDS[kind].models for kind in references):
                answering = ", ".join(name for name, kind in KINDS.items() if model in kind.models)
                raise self.error((), "references", f"no reference answers {model}; those that do are {answering}")
        return [(model, kind) for model in models for kind in references if model in KINDS[kind].models]

    def scene(self, name):
        if not name.endswith(".blend"):
            raise self.error((), "scenes", f"'{name}' is no .blend file")
        for folder in (self.path.parent, Path.cwd()):
            if (folder / name).is_file():
                return str((folder / name).resolve())
        raise self.error((), "scenes", f"there is no scene '{name}' beside the file or in the working folder")

    def names(self, key, allowed):
        values = self.table.get(key)
        if not isinstance(values, list) or not values or not all(isinstance(value, str) for value in values):
            what = f"some of {', '.join(allowed)}" if allowed else "one or more .blend files"
            raise self.error((), key, f"{key} must be a list with {what}")
        for value in values:
            if allowed and value not in allowed:
                raise self.error((), key, f"'{value}' is not one of the {key}; allowed are {', '.join(allowed)}")
            if values.count(value) > 1:
                raise self.error((), key, f"'{value}' stands twice in {key}; name each once")
        return values

    def section(self, key):
        values = self.table.get(key, {})
        if not isinstance(values, dict):
            raise self.error((), key, f"{key} must be a table, written [{key}]")
        return values

    def rows(self):
        rows = self.table.get("list", [{}])
        if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows) or not rows:
            raise self.error((), "list", "list must be an array of tables, each written [[list]]")
        return [self.parameters(("list",), row, index) for index, row in enumerate(rows)]

    def parameters(self, section, values, occurrence=0):
        return {name: self.parameter(section, name, value, occurrence) for name, value in values.items()}

    def axis(self, name, values):
        if not isinstance(values, list) or not values:
            raise self.error(("grid",), name, f"{name} must be a list of the values to sweep")
        checked = [self.parameter(("grid",), name, value) for value in values]
        for value in checked:
            if checked.count(value) > 1:
                raise self.error(("grid",), name, f"{_short(value)} stands twice in {name}; name each value once")
        return checked

    def parameter(self, section, name, value, occurrence=0):
        if name not in SETTABLE:
            raise self.error(
                section,
                name,
                f"'{name}' is not a material's parameter; allowed are {', '.join(SETTABLE)}",
                occurrence,
            )
        checked = PARAMETERS[name].check(value)
        if checked is None:
            allowed = PARAMETERS[name].allowed
            raise self.error(section, name, f"{name} must be {allowed}; got {_came(value)}", occurrence)
        return list(checked) if isinstance(checked, tuple) else checked

    def value(self, section, name, value, kind, occurrence=0):
        if isinstance(kind, Whole) and name == "size" and isinstance(value, list) and len(value) == 2:
            return [self.value(section, name, side, kind, occurrence) for side in value]
        checked = kind.check(value)
        if checked is None:
            raise self.error(section, name, f"{name} must be {kind}; got {_came(value)}", occurrence)
        return checked

    def error(self, section, key, what, occurrence=0):
        line = self.line(section, key, occurrence)
        where = f"line {line} of '{self.path}'" if line else f"'{self.path}'"
        return PlanError(f"In {where}, {what}.")

    def line(self, section, key, occurrence):
        """The number of the line that gives `key` in the table `section` (its `occurrence`-th), or 0."""
        current, seen = (), {}
        for number, text in enumerate(self.lines, 1):
            if header := re.match(r"\s*\[\[?\s*([\w.\- ]+?)\s*\]\]?", text):
                current = (header[1],)
                seen[current] = seen.get(current, -1) + 1
                if not section and header[1] == key:
                    return number
            elif re.match(rf"\s*[\"']?{re.escape(key)}[\"']?\s*=", text):
                if current == section and seen.get(section, 0) == occurrence:
                    return number
        # Not on a line of its own: with dots (material.g = 0), or in a table on one line (material = { g = 0 }).
        table = re.escape(section[0]) if section else re.escape(key)
        dotted = rf"\s*{table}\s*\.\s*{re.escape(key)}\s*="
        for pattern in (dotted, rf"\s*{table}\s*="):
            for number, text in enumerate(self.lines, 1):
                if re.match(pattern, text):
                    return number
        return 0


def _came(value):
    """A value as a message shows it."""
    try:
        text = repr(value)
    except ValueError:  # Python writes no number of thousands of digits
        text = "a number of thousands of digits"
    return text if len(text) <= MOST_SHOWN else f"{text[:MOST_SHOWN]}..."


def _short(value):
    if isinstance(value, list):
        return f"{value[0]:g}" if len(set(value)) == 1 else "/".join(f"{channel:g}" for channel in value)
    return f"{value:g}" if isinstance(value, float) else str(value)

# Reads a sweep's TOML file and unfolds it into cases.
"""See `read`. The file's form is in docs/sweeps.md."""
import hashlib
import itertools
import json
import re
import tomllib
from dataclasses import dataclass
from pathlib import Path

MODELS = ("lambert", "conductor", "model_1", "model_2", "model_3")
REFERENCES = ("diffuse", "glossy", "volume_index_matched", "subsurface")
PROFILES = ("half_space", "better_dipole", "dipole", "photon_beam")
LARGEST_COEFFICIENT = 1e12


class PlanError(Exception):
    """The file cannot be swept: one sentence that names the line and what is allowed."""


@dataclass(frozen=True)
class Number:
    """A number in [low, high]."""

    low: float
    high: float

    def check(self, value):
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not self.low <= value <= self.high:
            return None
        return float(value)

    def __str__(self):
        return f"a number from {self.low:g} to {self.high:g}"


@dataclass(frozen=True)
class Colour:
    """One number for all three channels of linear RGB, or three."""

    low: float
    high: float

    def check(self, value):
        values = value if isinstance(value, list) else [value] * 3
        numbers = [Number(self.low, self.high).check(channel) for channel in values]
        return numbers if len(numbers) == 3 and None not in numbers else None

    def __str__(self):
        return f"a number or three of them, from {self.low:g} to {self.high:g}"


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


# Boundary and masking are not among them: the kind of reference decides both.
PARAMETERS = {
    "reflectance": Colour(0.0, 1.0),
    "sigma_a": Colour(0.0, LARGEST_COEFFICIENT),
    "sigma_s": Colour(0.0, LARGEST_COEFFICIENT),
    "g": Number(-1.0, 1.0),
    "eta": Number(0.5, 4.0),
    "roughness": Number(0.0, 1.0),
    "scale": Number(0.0, LARGEST_COEFFICIENT),
    "profile": Choice(PROFILES),
}
SETTINGS = {
    "size": Whole(8, 16384),
    "samples": Whole(1, 1 << 20),
    "reference_samples": Whole(1, 1 << 20),
}
TOP_LEVEL = ("title", "scenes", "models", "references", "material", "grid", "list", *SETTINGS)


@dataclass(frozen=True)
class Case:
    """One comparison: everything that determines it, and a name made from that.

    scene: absolute path. parameters: of the material, those that differ from the scene's. settings: size, samples, ...
    """

    scene: str
    model: str
    reference: str | None
    parameters: tuple
    settings: tuple
    label: str

    @property
    def key(self):
        """Sixteen hexadecimal digits that stand for all that determines the case, the scene's content included."""
        content = hashlib.sha256(Path(self.scene).read_bytes()).hexdigest()
        described = json.dumps([content, self.model, self.reference, self.parameters, self.settings])
        return hashlib.sha256(described.encode()).hexdigest()[:16]

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


def read(path):
    """Plan of the TOML file at `path`; scenes are looked for beside the file, then in the working folder.

    Raises PlanError: what is wrong, in which line, and what is allowed.
    """
    path = Path(path)
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise PlanError(f"The sweep '{path}' cannot be read: {error}.") from error
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
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
        models = self.names("models", MODELS)
        references = self.names("references", REFERENCES) if "references" in self.table else [None]
        settings = {
            name: self.value((), name, self.table[name], kind)
            for name, kind in SETTINGS.items()
            if name in self.table
        }
        fixed = self.parameters(("material",), self.section("material"))
        grid = self.section("grid")
        rows = self.rows()
        axes = tuple(dict.fromkeys([*grid, *(name for row in rows for name in row)]))

        cases = []
        for scene, model, reference, row, *point in itertools.product(
            scenes, models, references, rows, *(self.axis(name, values) for name, values in grid.items())
        ):
            parameters = {**fixed, **row, **dict(zip(grid, point, strict=True))}
            varying = {name: parameters[name] for name in axes if name in parameters}
            label = " ".join(
                [Path(scene).stem, model, *(f"{name}={_short(value)}" for name, value in varying.items())]
            )
            cases.append(
                Case(
                    scene, model, reference, tuple(sorted(parameters.items())), tuple(sorted(settings.items())), label
                )
            )
        return Plan(str(self.table.get("title", self.path.stem)), str(self.path), axes, tuple(cases))

    def scene(self, name):
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
        return [self.parameter(("grid",), name, value) for value in values]

    def parameter(self, section, name, value, occurrence=0):
        if name not in PARAMETERS:
            raise self.error(
                section,
                name,
                f"'{name}' is not a material's parameter; allowed are {', '.join(PARAMETERS)}",
                occurrence,
            )
        return self.value(section, name, value, PARAMETERS[name], occurrence)

    def value(self, section, name, value, kind, occurrence=0):
        if isinstance(kind, Whole) and name == "size" and isinstance(value, list) and len(value) == 2:
            return [self.value(section, name, side, kind, occurrence) for side in value]
        checked = kind.check(value)
        if checked is None:
            raise self.error(section, name, f"{name} must be {kind}; got {value!r}", occurrence)
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
        return 0


def _short(value):
    if isinstance(value, list):
        return f"{value[0]:g}" if len(set(value)) == 1 else "/".join(f"{channel:g}" for channel in value)
    return f"{value:g}" if isinstance(value, float) else str(value)

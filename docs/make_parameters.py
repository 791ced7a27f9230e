"""Prints parameters.md, the tables of a grain's parameters and of the models, from the schema of the add-on.

    python3 docs/make_parameters.py > docs/parameters.md
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "addon"))

from mesograin.schema.models import CHOICES  # noqa: E402
from mesograin.schema.parameters import PARAMETERS, SCENE  # noqa: E402

HEAD = """# Parameters and models

What a grain's material says, by the names that GLSL, C++, Python, JSON, TOML, the command line and the panel share.
`length` is the millimetre in Blender, on the command line and in sweeps, and the scene's unit elsewhere. These tables
are made from `grain.json`, `auto.json` and `scene.json` in `addon/mesograin/schema` by `docs/make_parameters.py`.
"""


def shown(parameter):
    """The default, as one writes it."""
    value = parameter.default
    if isinstance(value, tuple):
        return f"{value[0]:g}" if len(set(value)) == 1 else ", ".join(f"{channel:g}" for channel in value)
    return str(value).lower() if isinstance(value, bool) else f"{value:g}" if isinstance(value, float) else value


def table(columns, rows):
    """Lines of Markdown."""
    return [f"| {' | '.join(columns)} |", "|" + "---|" * len(columns), *(f"| {' | '.join(row)} |" for row in rows), ""]


def text(sentence, note=""):
    """Sentences with their full stops."""
    return f"{sentence}. {note}." if note else f"{sentence}."


def page():
    """The whole page."""
    lines = [HEAD, "## Parameters", ""]
    lines += table(("parameter", "takes", "unit", "default", "meaning"),
                   [(f"`{name}`", "a name, see below" if parameter.kind == "choice" else parameter.allowed,
                     parameter.unit, f"`{shown(parameter)}`", text(parameter.sentence, parameter.note))
                    for name, parameter in PARAMETERS.items()])
    for name, parameter in PARAMETERS.items():
        if parameter.kind == "choice" and name != "model":
            lines += [f"## `{name}`", ""]
            lines += table(("value", "meaning"),
                           [(f"`{choice.name}`", text(choice.sentence)) for choice in parameter.choices])
    lines += ["## Of a scene", "",
              "Keys of a scene's JSON and of `native.Scene`, in the render panel; the first is `--exchange` of the "
              "commands.", ""]
    for name, parameter in SCENE.items():
        lines += [f"`{name}`, by default `{shown(parameter)}`. {text(parameter.sentence, parameter.note)}", ""]
        if parameter.choices:
            lines += table(("value", "meaning"),
                           [(f"`{choice.name}`", text(choice.sentence)) for choice in parameter.choices])
    lines += ["## Models", ""]
    lines += table(("model", "meaning", "parameters that it reads"),
                   [(f"`{model.name}`", text(model.sentence), _parameters(model)) for model in CHOICES.values()])
    return "\n".join(lines).rstrip("\n") + "\n"


def _parameters(model):
    names = ", ".join(f"`{name}`" for name in model.parameters)
    profiles = ", ".join(f"`{name}`" for name in model.profiles)
    return names + (f"; of the profiles {profiles}" if profiles else "")


if __name__ == "__main__":
    sys.stdout.write(page())

"""Writes scene/grain.h, what C++ knows of a grain's parameters and models, from addon/mesograin/schema/grain.json.

    make_grain.py GRAIN.json grain.h
"""
import json
import pathlib
import sys

BANNER = ("// A grain's material and the models that answer it. "
          "Made from addon/mesograin/schema/grain.json, the place for changes.")
TYPES = {"number": "double", "rgb": "glm::dvec3", "switch": "bool"}
LISTS = ("kinds", "parameters", "profiles")
FLAGS = ("translucent", "preferred", "grain_radius", "light_maps", "taps", "mesh")


def enum_of(parameter):
    """Boundary for boundary."""
    return "".join(word.capitalize() for word in parameter["name"].split("_"))


def literal(value):
    """A number, or three, as C++ writes it."""
    if isinstance(value, list):
        return ", ".join(map(literal, value))
    return str(value).lower() if isinstance(value, bool) else repr(float(value))


def quoted(text):
    return json.dumps(text)


def names(array, values):
    """The constant array of some names."""
    return (f"inline constexpr std::array<std::string_view, {len(values)}> {array}{{" +
            ", ".join(map(quoted, values)) + "};\n")


def choice(parameter):
    """The enum of a choice, its names, and how templates find both."""
    enum = enum_of(parameter)
    values = "".join(f"  {entry['name']},  ///< {entry['sentence']}\n" for entry in parameter["choices"])
    array = f"{parameter['name']}_names"
    return (f"/// {parameter['sentence']}.\nenum class {enum} {{\n{values}}};\n" +
            names(array, [entry["name"] for entry in parameter["choices"]]) +
            f"constexpr std::span<const std::string_view> names_of({enum}) {{ return {array}; }}\n"
            f"constexpr std::string_view parameter_of({enum}) {{ return {quoted(parameter['name'])}; }}\n\n")


def member(parameter):
    """The parameter's line in Material."""
    if parameter["kind"] == "choice":
        declared = f"{enum_of(parameter)} {parameter['name']} = {enum_of(parameter)}::{parameter['default']}"
    else:
        declared = f"{TYPES[parameter['kind']]} {parameter['name']}{{{literal(parameter['default'])}}}"
    return f"  {declared};  ///< {parameter['sentence']}\n"


def visit(parameter):
    """The call that shows a parameter to a visitor."""
    fields = [f".name = {quoted(parameter['name'])}", f".sentence = {quoted(parameter['sentence'])}"]
    if "least" in parameter:
        fields += [f".least = {literal(parameter['least'])}", f".most = {literal(parameter['most'])}"]
    if parameter.get("required"):
        fields.append(".required = true")
    return f"  visit(Parameter{{{', '.join(fields)}}}, &Material::{parameter['name']});\n"


def model(entry):
    """The arrays that a model's traits refer to, and the traits."""
    name = entry["name"]
    arrays = "".join(names(f"{name}_{key}", entry.get(key, [])) for key in LISTS)
    flags = ", ".join(f".{flag} = true" for flag in FLAGS if entry.get(flag))
    lists = ", ".join(f".{key} = {name}_{key}" for key in LISTS)
    near_lamps = f".near_lamps = {quoted(entry.get('near_lamps', ''))}"
    return arrays, f"    {{.name = {quoted(name)}, {lists}{', ' + flags if flags else ''}, {near_lamps}}},\n"


def header(text):
    grain = json.loads(text)
    for parameter in grain["parameters"]:
        if parameter["name"] == "model":
            parameter["choices"] = grain["models"]
    parameters, models = grain["parameters"], grain["models"]
    choices = "".join(choice(parameter) for parameter in parameters if parameter["kind"] == "choice")
    arrays, traits = zip(*map(model, models))
    return f"""{BANNER}
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string_view>

#include "scene/finish.h"
#include "scene/schema.h"

namespace mesograin::scene {{

{choices}struct Material {{
{"".join(map(member, parameters))}  std::optional<Finish> finish{{}};  ///< of an opaque surface, beside its model
  bool operator==(const Material&) const = default;
}};

/// Calls visit(Parameter, pointer to the member of Material) for each parameter.
template <typename Visit>
void for_each_parameter(Visit visit) {{
{"".join(map(visit, parameters))}}}

{"".join(arrays)}
/// In the order of Model.
inline constexpr std::array<ModelTraits, {len(models)}> model_traits{{{{
{"".join(traits)}}}}};

/// The schema's own text.
inline constexpr std::string_view grain_schema = R"~json~({text})~json~";

}}  // namespace mesograin::scene

/// Repeats a macro for each model's name.
#define MESOGRAIN_FOR_EACH_MODEL(DO) {" ".join(f"DO({entry['name']})" for entry in models)}
"""


if __name__ == "__main__":
    source, target = map(pathlib.Path, sys.argv[1:])
    text = header(source.read_text(encoding="utf-8"))
    # Whoever includes it is compiled again only when it says something else.
    if not target.exists() or target.read_text(encoding="utf-8") != text:
        target.write_text(text, encoding="utf-8")

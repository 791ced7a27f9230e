"""Writes scene/auto.h, by which a model is chosen, from addon/mesograin/schema/auto.json.

    make_auto.py AUTO.json auto.h
"""
import json
import pathlib
import sys


def points(table):
    return "".join(f"{{.radius = {float(radius)!r}, .error = {float(error)!r}}}, " for radius, error in table)[:-2]


def header(text):
    auto = json.loads(text)
    shapes = {"round": auto["round"]}
    for shape in ("less_round", "flat"):
        shapes[shape] = {name: auto[shape][name] for name in auto["round"]}
    tables = "".join(f"inline constexpr std::array<Measured, {len(table)}> {shape}_{name}{{{{{points(table)}}}}};\n"
                     for shape, of_models in shapes.items() for name, table in of_models.items())
    entries = "".join(f"    {{Model::{name}, round_{name}, less_round_{name}, flat_{name}}},\n"
                      for name in auto["round"])
    forwards = auto["forwards"]["transport"]
    of_g = ", ".join(f"{{.g = {float(g)!r}, .error = {float(error)!r}}}" for g, error in forwards)
    return f"""// What the choice of a model goes by. Made from addon/mesograin/schema/auto.json, the place for changes.
#pragma once

#include <array>
#include <span>
#include <string_view>

#include "scene/material.h"

namespace mesograin::scene::automatic {{

/// radius: in mean free paths. error: measured, in %.
struct Measured {{
  double radius;
  double error;
}};
/// Of a sphere, of grains of roundness_of_less_round, and of flat ones of roundness_of_flat.
struct OfModel {{
  Model model;
  std::span<const Measured> round;
  std::span<const Measured> less_round;
  std::span<const Measured> flat;
}};

inline constexpr std::string_view name = {json.dumps(auto["name"])};
inline constexpr double tolerance = {float(auto["tolerance"])!r};
inline constexpr double roundness_of_less_round = {float(auto["less_round"]["roundness"])!r};
inline constexpr double roundness_of_flat = {float(auto["flat"]["roundness"])!r};
/// Mean free paths to the radius, of the channel in the middle and of the densest; or of all.
inline constexpr double most_transported = {float(auto["most_transported"]["middle"])!r};
inline constexpr double densest_transported = {float(auto["most_transported"]["densest"])!r};
inline constexpr double all_transported = {float(auto["most_transported"]["all"])!r};
inline constexpr double transport_error = {float(auto["angular"]["transport"])!r};
inline constexpr double most_g = {float(auto["forwards"]["most_g"])!r};
/// Up to this |g|.
struct Forwards {{
  double g;
  double error;
}};
inline constexpr std::array<Forwards, {len(forwards)}> forwards{{{{{of_g}}}}};
inline constexpr double model_3_error = {float(auto["angular"]["model_3"])!r};
/// Of radius 20: the most that is stored, and where it is too thick for that.
inline constexpr double thick_transport_error = {float(auto["thick"]["transport"])!r};
inline constexpr double thick_model_3_error = {float(auto["thick"]["model_3"])!r};
{tables}/// The cheapest first.
inline constexpr std::array<OfModel, {len(auto["round"])}> of_models{{{{
{entries}}}}};

}}  // namespace mesograin::scene::automatic
"""


if __name__ == "__main__":
    source, target = map(pathlib.Path, sys.argv[1:])
    target.write_text(header(source.read_text(encoding="utf-8")), encoding="utf-8")

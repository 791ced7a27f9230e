// What is known of a parameter and of a model apart from its physics; the values are in
// addon/mesograin/schema/grain.json.
#pragma once

#include <limits>
#include <span>
#include <string_view>

namespace mesograin::scene {

struct Parameter {
  std::string_view name;
  std::string_view sentence;  ///< what it is
  double least = -std::numeric_limits<double>::max();
  double most = std::numeric_limits<double>::max();
  bool required = false;  ///< a scene in JSON must say it
};

struct ModelTraits {
  std::string_view name;
  std::span<const std::string_view> kinds;       ///< of material.kind in a scene's JSON, that it answers
  std::span<const std::string_view> parameters;  ///< that it reads
  std::span<const std::string_view> profiles;    ///< that it knows; empty for all
  bool translucent = false;                      ///< light goes through it
  bool preferred = false;                        ///< stands for its kinds where none is named
  bool grain_radius = false;                     ///< its inputs depend on the grain's size
  bool light_maps = false;                       ///< it reads shaders/models/light_map.glsl
  bool taps = false;                             ///< it takes samples of the lit surface, whose number may be chosen
  bool mesh = false;                             ///< its inputs depend on the grain's mesh: models::prototype_inputs
  std::string_view near_lamps;                   ///< the model that draws a single grain there, alike; empty for itself
};

}  // namespace mesograin::scene

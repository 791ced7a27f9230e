// What a material's shader program needs beyond the geometry: compile-time choices, uniforms by name, tables.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "scene/material.h"

namespace mesograin::physics {

using UniformValue = std::variant<int, float, glm::vec2, glm::vec3, glm::vec4>;

/// A 2-D table of RGBA float texels, row-major, sampled with linear filtering and clamped coordinates.
struct Table {
  int width = 0;
  int height = 0;
  std::vector<glm::vec4> texels;
};

struct MaterialInputs {
  std::vector<std::string> defines;              ///< chosen at compile time: one program for each distinct set
  std::map<std::string, UniformValue> uniforms;  ///< "material.sigma_a", ...
  std::map<std::string, Table> tables;           ///< sampler name -> texels
  bool light_maps = false;                       ///< the model reads shaders/models/light_map.glsl
};

/// Computed once for each material, in double. Throws Error if the material is not valid. `grain_radius` is that of the
/// sphere with the grain's mean chord, in scene units; only models 2 and 3 depend on it.
MaterialInputs material_inputs(const scene::Material& material, double grain_radius = 1.0);

/// Whether the model's inputs depend on the grain's radius.
bool depends_on_grain_radius(scene::Model model);

}  // namespace mesograin::physics

// What a material's shader program needs beyond the geometry: compile-time choices, uniforms by name, tables.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "physics/table.h"
#include "scene/material.h"

namespace mesograin::models {

using physics::Table;
using UniformValue = std::variant<int, float, glm::vec2, glm::vec3, glm::vec4>;

/// Texels with 1 to 4 channels, x fastest, then y; sampled linearly, clamped. Of half precision, or of a byte, which
/// holds -1 to 1 in steps of 1/127.
struct Volume {
  int width = 0;
  int height = 0;
  int depth = 0;
  int channels = 4;
  std::vector<float> texels;
  bool bytes = false;
};

struct MaterialInputs {
  std::vector<std::string> defines;                     ///< chosen at compile time: one program for each distinct set
  std::map<std::string, UniformValue> uniforms;         ///< "material.sigma_a", ...
  std::map<std::string, Table> tables;                  ///< sampler name -> texels
  std::map<std::string, Volume> volumes;                ///< sampler name -> texels
  std::map<std::string, scene::TextureMap> pictures{};  ///< sampler name -> what it wears
  bool finish = false;                                  ///< drawn by shaders/models/finish.glsl, whatever the model
  bool facets = false;                                  ///< the surface is of facets that mirror, and they are seen
  bool light_maps = false;                              ///< the model reads shaders/models/light_map.glsl
};

/// Throws Error if the material is not valid.
void require_valid(const scene::Material& material);

/// Computed once for each material, in double. Throws Error if the material is not valid. `grain_radius` is that of the
/// sphere with the grain's mean chord, in scene units; only models whose traits say so depend on it.
MaterialInputs material_inputs(const scene::Material& material, double grain_radius = 1.0);

}  // namespace mesograin::models

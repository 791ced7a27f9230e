// Pictures by the names of what they are of, and the numbers where there is none.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

#include "models/finish.h"
#include "physics/fresnel_moments.h"
#include "physics/half_space/facet_energy.h"

namespace mesograin::models {
namespace {

constexpr double most_coat = 0.99;
constexpr int energy_rows = 17;  // where a picture says how rough it is

void add_map(std::string_view name, const scene::TextureMap& map, MaterialInputs& inputs) {
  if (!map.picture) return;
  std::string define(name);
  std::transform(define.begin(), define.end(), define.begin(), [](unsigned char c) { return std::toupper(c); });
  inputs.defines.push_back(define + "_MAP");
  const std::string uniform = fmt::format("{}_map.", name);
  inputs.uniforms[uniform + "across"] = glm::vec4(map.to_picture[0]);
  inputs.uniforms[uniform + "up"] = glm::vec4(map.to_picture[1]);
  inputs.uniforms[uniform + "by_position"] = static_cast<int>(map.by_position);
  inputs.uniforms[uniform + "srgb"] = static_cast<int>(map.picture->srgb());
  inputs.pictures[fmt::format("{}_picture", name)] = map;
}

// What shaders need to send on what one bounce loses, and to shade what a coat lies on.
void add_energy(const scene::Material& material, double roughness, MaterialInputs& inputs) {
  const scene::Finish& finish = *material.finish;
  const double root = std::sqrt(std::min(finish.coat, most_coat));
  const double eta = (1.0 + root) / (1.0 - root);
  std::vector<double> roughnesses{roughness};
  if (finish.roughness.picture) {
    roughnesses.clear();
    for (int row = 0; row < energy_rows; ++row) roughnesses.push_back(static_cast<double>(row) / (energy_rows - 1));
  }
  inputs.defines.emplace_back("FACET_ENERGY");
  inputs.tables["facet_energy"] = physics::facet_energy(eta, roughnesses, material.masking);
  inputs.uniforms["material.coat_mean"] = static_cast<float>(physics::fresnel_moments(eta).two_c1());
}

}  // namespace

void add_finish(const scene::Material& material, MaterialInputs& inputs) {
  const scene::Finish& finish = *material.finish;
  const bool metal = material.model == scene::Model::conductor;
  const double metallicity = metal ? 1.0 : finish.metallicity;
  inputs.finish = true;
  add_map("reflectance", finish.reflectance, inputs);
  add_map("roughness", finish.roughness, inputs);
  add_map("metallic", finish.metallic, inputs);
  add_map("normal", finish.normal, inputs);
  add_map("emission", finish.emission, inputs);
  if (!inputs.pictures.empty()) inputs.defines.emplace_back("TEXTURED");
  if (finish.radiance != glm::dvec3(0.0)) inputs.defines.emplace_back("EMITS");
  if (finish.coat > 0.0) inputs.defines.emplace_back("COAT");
  if (finish.coat_shades_base) inputs.defines.emplace_back("COAT_SHADES_BASE");
  if (finish.metal_whitens) inputs.defines.emplace_back("METAL_WHITENS");
  if (finish.facets_keep_energy) inputs.defines.emplace_back("FACETS_KEEP_ENERGY");
  if (finish.facets_shade_bumps) inputs.defines.emplace_back("FACETS_SHADE_BUMPS");
  if (finish.bent_normals_stay) inputs.defines.emplace_back("BENT_NORMALS_STAY");
  if (finish.retro_reflective) inputs.defines.emplace_back("RETRO_REFLECTIVE");
  if (finish.diffuse_roughness > 0.0 && !finish.retro_reflective) inputs.defines.emplace_back("ROUGH_DIFFUSE");
  const bool metallic = metallicity > 0.0 || finish.metallic.picture;
  if (metallic) inputs.defines.emplace_back("METALLIC");
  inputs.facets = metallic || finish.coat > 0.0;
  // Of the conductor it is the alpha, of which the finish has the root.
  const double roughness = metal ? std::sqrt(material.roughness) : finish.coat_roughness;
  if (inputs.facets && (finish.coat_shades_base || finish.facets_keep_energy)) add_energy(material, roughness, inputs);
  if (material.masking == scene::Masking::separable && !metal) inputs.defines.emplace_back("MASKING_SEPARABLE");
  inputs.uniforms["material.reflectance"] = glm::vec3(material.reflectance);
  inputs.uniforms["material.roughness"] = static_cast<float>(roughness);
  inputs.uniforms["material.diffuse_roughness"] = static_cast<float>(finish.diffuse_roughness);
  inputs.uniforms["material.metallicity"] = static_cast<float>(metallicity);
  inputs.uniforms["material.coat"] = static_cast<float>(finish.coat);
  inputs.uniforms["material.normal_strength"] = static_cast<float>(finish.normal_strength);
  inputs.uniforms["material.radiance"] = glm::vec3(finish.radiance);
}

}  // namespace mesograin::models

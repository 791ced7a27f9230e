// Looks each model's inputs up by its place in the schema.
#include "models/material_inputs.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "base/error.h"
#include "models/finish.h"
#include "models/inputs_of_models.h"

namespace mesograin::models {
namespace {

using Inputs = MaterialInputs (*)(const scene::Material&, double);

#define MESOGRAIN_INPUTS(model) &model##_inputs,
constexpr std::array<Inputs, scene::model_traits.size()> inputs_of{MESOGRAIN_FOR_EACH_MODEL(MESOGRAIN_INPUTS)};
#undef MESOGRAIN_INPUTS

void require_known_profile(const scene::Material& material, const scene::ModelTraits& traits) {
  const std::string_view profile = scene::name_of(material.profile);
  if (!traits.profiles.empty() && std::ranges::find(traits.profiles, profile) == traits.profiles.end())
    throw Error("profile for {} must be one of {}; got '{}'.", traits.name, fmt::join(traits.profiles, ", "), profile);
}

}  // namespace

void require_valid(const scene::Material& material) {
  scene::validate(material);
  require_known_profile(material, scene::traits_of(material.model));
}

MaterialInputs material_inputs(const scene::Material& material, double grain_radius) {
  require_valid(material);
  const scene::ModelTraits& traits = scene::traits_of(material.model);
  MaterialInputs inputs = inputs_of[static_cast<std::size_t>(material.model)](material, grain_radius);
  inputs.light_maps = traits.light_maps;
  if (material.finish) add_finish(material, inputs);
  return inputs;
}

}  // namespace mesograin::models

// Ranges and names of a material's parameters.
#include "scene/material.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/error.h"

namespace mesograin::scene {
namespace {

void require_range(std::string_view parameter, double value, double low, double high) {
  if (!(value >= low && value <= high)) {
    if (std::isinf(high)) throw Error("{} must be a finite number of at least {}; got {}.", parameter, low, value);
    throw Error("{} must lie between {} and {}; got {}.", parameter, low, high, value);
  }
}

void require_rgb(std::string_view parameter, const glm::dvec3& value, double high) {
  constexpr std::array channel_names{"R", "G", "B"};
  for (int channel = 0; channel < 3; ++channel)
    require_range(fmt::format("{} (channel {})", parameter, channel_names[channel]), value[channel], 0.0, high);
}

template <typename Enum, std::size_t Count>
Enum parse_enum(const std::array<std::string_view, Count>& names, std::string_view name, std::string_view parameter) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw Error("{} must be one of {}; got '{}'.", parameter, fmt::join(names, ", "), name);
  return static_cast<Enum>(found - names.begin());
}

}  // namespace

void validate(const Material& material) {
  // A coefficient beyond this cannot be told from an opaque (or, times zero, a clear) medium in single precision.
  constexpr double largest_coefficient = 1e12;
  require_rgb("reflectance", material.reflectance, 1.0);
  require_rgb("sigma_a", material.sigma_a, largest_coefficient);
  require_rgb("sigma_s", material.sigma_s, largest_coefficient);
  require_range("g", material.g, -1.0, 1.0);
  require_range("eta", material.eta, 0.5, 4.0);
  require_range("roughness", material.roughness, 0.0, 1.0);
  require_range("scale", material.scale, 0.0, largest_coefficient);
}

Model parse_model(std::string_view name) { return parse_enum<Model>(model_names, name, "model"); }
Boundary parse_boundary(std::string_view name) { return parse_enum<Boundary>(boundary_names, name, "boundary"); }
Masking parse_masking(std::string_view name) { return parse_enum<Masking>(masking_names, name, "masking"); }
Profile parse_profile(std::string_view name) { return parse_enum<Profile>(profile_names, name, "profile"); }

}  // namespace mesograin::scene

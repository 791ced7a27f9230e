// Ranges and names of a material's parameters.
#include "scene/material.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "base/error.h"

namespace mesograin::scene {
namespace {

void require_range(std::string_view name, const Parameter& parameter, double value) {
  if (value >= parameter.least && value <= parameter.most) return;
  if (parameter.most == std::numeric_limits<double>::max())
    throw Error("{} must be a finite number of at least {}; got {}.", name, parameter.least, value);
  throw Error("{} must lie between {} and {}; got {}.", name, parameter.least, parameter.most, value);
}

void require(const Parameter& parameter, double value) { require_range(parameter.name, parameter, value); }

void require(const Parameter& parameter, const glm::dvec3& value) {
  constexpr std::array channel_names{"R", "G", "B"};
  for (int channel = 0; channel < 3; ++channel)
    require_range(fmt::format("{} (channel {})", parameter.name, channel_names[channel]), parameter, value[channel]);
}

// Every value of a switch or a choice is allowed.
template <typename Value>
void require(const Parameter& /*parameter*/, Value /*value*/) {}

}  // namespace

void validate(const Material& material) {
  for_each_parameter([&](const Parameter& parameter, auto member) { require(parameter, material.*member); });
  if (!material.finish) return;
  if (traits_of(material.model).translucent)
    throw Error("Only an opaque model's surface may have a finish; got {}.", name_of(material.model));
  validate(*material.finish);
}

std::size_t find_name(std::string_view parameter, std::span<const std::string_view> names, std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw Error("{} must be one of {}; got '{}'.", parameter, fmt::join(names, ", "), name);
  return static_cast<std::size_t>(found - names.begin());
}

}  // namespace mesograin::scene

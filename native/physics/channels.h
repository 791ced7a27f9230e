// Work done once for channels that are the same, and tables made of three channels.
#pragma once

#include <array>
#include <vector>

#include "physics/material_inputs.h"

namespace mesograin::physics {

/// Calls `compute` for each of the three, or only once for those that compare equal.
template <typename Medium, typename Compute>
auto for_each_channel(const std::array<Medium, 3>& media, Compute compute) {
  std::array<decltype(compute(media[0])), 3> results;
  for (int channel = 0; channel < 3; ++channel) {
    int same = 0;
    while (!(media[same] == media[channel])) ++same;
    results[channel] = same < channel ? results[same] : compute(media[channel]);
  }
  return results;
}

/// Row-major values of the three channels, alpha 1.
inline Table pack(const std::array<std::vector<double>, 3>& channels, int width, int height) {
  Table table{width, height, {}};
  table.texels.reserve(channels[0].size());
  for (std::size_t texel = 0; texel < channels[0].size(); ++texel)
    table.texels.emplace_back(glm::dvec4(channels[0][texel], channels[1][texel], channels[2][texel], 1.0));
  return table;
}

}  // namespace mesograin::physics

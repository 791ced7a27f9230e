// Numbers that a shader looks up, and how three channels make one table.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec4.hpp>
#include <vector>

namespace mesograin::physics {

/// A 2-D table of RGBA float texels, row-major, sampled with linear filtering and clamped coordinates.
struct Table {
  int width = 0;
  int height = 0;
  std::vector<glm::vec4> texels;
};

/// Row-major values of the three channels, alpha 1.
inline Table pack(const std::array<std::vector<double>, 3>& channels, int width, int height) {
  Table table{width, height, {}};
  table.texels.reserve(channels[0].size());
  for (std::size_t texel = 0; texel < channels[0].size(); ++texel)
    table.texels.emplace_back(glm::dvec4(channels[0][texel], channels[1][texel], channels[2][texel], 1.0));
  return table;
}

}  // namespace mesograin::physics

// Directions as texels of a square: the octahedral map (Cigolle et al., "A survey of efficient representations for
// independent unit vectors", JCGT 2014).
#pragma once

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace mesograin::transport {

/// Texels along each side of the map.
inline constexpr int octahedron_side = 32;
inline constexpr int octahedron_texels = octahedron_side * octahedron_side;

/// The direction at u, v in [0, 1]: z is up in the middle and down in the corners.
inline glm::vec3 octahedron_direction(float u, float v) {
  const float x = 2.0F * u - 1.0F, y = 2.0F * v - 1.0F;
  const float z = 1.0F - std::abs(x) - std::abs(y);
  const float fold = std::fmax(-z, 0.0F);
  return glm::normalize(glm::vec3(x - std::copysign(fold, x), y - std::copysign(fold, y), z));
}

/// The direction in a texel's middle.
inline glm::vec3 octahedron_direction(int texel) {
  constexpr auto side = static_cast<float>(octahedron_side);
  const int row = texel / octahedron_side;
  return octahedron_direction((static_cast<float>(texel % octahedron_side) + 0.5F) / side,
                              (static_cast<float>(row) + 0.5F) / side);
}

/// The texels' solid angles; 4 pi together.
std::array<float, octahedron_texels> octahedron_solid_angles();

}  // namespace mesograin::transport

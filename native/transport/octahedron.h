// Directions as texels of a square: the octahedral map (Cigolle et al., "A survey of efficient representations for
// independent unit vectors", JCGT 2014).
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace mesograin::transport {

/// Texels along each side of the map, where nothing else is said.
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
inline glm::vec3 octahedron_direction(int texel, int side = octahedron_side) {
  const int row = texel / side;
  return octahedron_direction((static_cast<float>(texel % side) + 0.5F) / static_cast<float>(side),
                              (static_cast<float>(row) + 0.5F) / static_cast<float>(side));
}

/// The texel at x, y: beyond an edge a map goes on mirrored about that edge's middle.
inline int octahedron_texel(int x, int y, int side = octahedron_side) {
  const int last = side - 1;
  if (x < 0 || x > last) {
    x = x < 0 ? 0 : last;
    y = last - y;
  }
  if (y < 0 || y > last) {
    y = y < 0 ? 0 : last;
    x = last - x;
  }
  return y * side + x;
}

/// A map with `side` texels along a side as one with all, linear between the middles of those.
std::vector<float> octahedron_map(const std::vector<float>& values, int side);

/// The texels' solid angles; 4 pi together.
std::vector<float> octahedron_solid_angles(int side = octahedron_side);

}  // namespace mesograin::transport

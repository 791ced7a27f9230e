// Small closed meshes.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "scene/mesh.h"

namespace mesograin::transport {

inline std::vector<glm::vec3> box_positions() {
  std::vector<glm::vec3> positions;
  for (unsigned corner = 0; corner < 8; ++corner)
    positions.emplace_back((corner & 1U) != 0 ? 1.0F : -1.0F, (corner & 2U) != 0 ? 1.0F : -1.0F,
                           (corner & 4U) != 0 ? 1.0F : -1.0F);
  return positions;
}

inline std::vector<glm::uvec3> box_triangles() {
  return {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
          {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
}

/// Two boxes, one above the other, `gap` between them; each 2 wide and deep and `height` high.
inline scene::Mesh plates(float height, float gap) {
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
  for (const float middle : {-0.5F * (gap + height), 0.5F * (gap + height)}) {
    const auto first = static_cast<unsigned>(positions.size());
    for (const glm::vec3& corner : box_positions())
      positions.emplace_back(corner.x, corner.y, middle + 0.5F * height * corner.z);
    for (const glm::uvec3& triangle : box_triangles()) triangles.push_back(triangle + first);
  }
  return {positions, {}, triangles};
}

/// A cube from -1 to 1.
inline scene::Mesh cube() { return {box_positions(), {}, box_triangles()}; }

}  // namespace mesograin::transport

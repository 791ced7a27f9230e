// A mesh as a device's rays meet it.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "casting/flat_tree.h"
#include "scene/mesh.h"

namespace mesograin::casting {

struct FlatMesh {
  std::vector<FlatNode> nodes;
  std::vector<glm::uvec3> corners;  ///< of triangles, as leaves name them
  std::vector<glm::vec4> vertices;  ///< two each: where it is from `middle` and u, its normal and v
};

/// Throws Error as flat_tree().
FlatMesh flat_mesh(const scene::Mesh& mesh, const glm::vec3& middle, unsigned most_depth);

}  // namespace mesograin::casting

// A few triangles to a leaf.
#include "casting/flat_mesh.h"

#include <glm/common.hpp>
#include <utility>

namespace mesograin::casting {
namespace {

constexpr std::size_t triangles_in_leaf = 2;

// Of a box that a flat triangle has: rays that graze it still enter.
constexpr float thickness = 1e-6F;

}  // namespace

FlatMesh flat_mesh(const scene::Mesh& mesh, const glm::vec3& middle, unsigned most_depth) {
  FlatMesh result;
  const float margin = thickness * static_cast<float>(mesh.reach());
  std::vector<Box> boxes;
  boxes.reserve(mesh.triangles().size());
  for (const glm::uvec3& corners : mesh.triangles()) {
    const glm::vec3 a = mesh.positions()[corners.x] - middle, b = mesh.positions()[corners.y] - middle,
                    c = mesh.positions()[corners.z] - middle;
    boxes.push_back({glm::min(glm::min(a, b), c) - margin, glm::max(glm::max(a, b), c) + margin});
  }
  FlatTree tree = flat_tree(boxes, triangles_in_leaf, most_depth);
  result.nodes = std::move(tree.nodes);
  result.corners.reserve(tree.order.size());
  for (const std::uint32_t triangle : tree.order) result.corners.push_back(mesh.triangles()[triangle]);
  result.vertices.reserve(2 * mesh.positions().size());
  for (std::size_t i = 0; i < mesh.positions().size(); ++i) {
    const glm::vec2 uv = mesh.uvs().empty() ? glm::vec2(0.0F) : mesh.uvs()[i];
    result.vertices.emplace_back(mesh.positions()[i] - middle, uv.x);
    result.vertices.emplace_back(mesh.normals()[i], uv.y);
  }
  return result;
}

}  // namespace mesograin::casting

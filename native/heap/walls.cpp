// A wall's mesh where the heap is.
#include "heap/walls.h"

#include <algorithm>
#include <glm/vec3.hpp>
#include <utility>

namespace mesograin::heap {

std::vector<glm::vec3> places_of(const scene::Mesh& mesh, const glm::dmat4& to_heap) {
  std::vector<glm::vec3> places;
  places.reserve(mesh.positions().size());
  for (const glm::vec3& position : mesh.positions())
    places.emplace_back(to_heap * glm::dvec4(glm::dvec3(position), 1.0));
  return places;
}

bool Wall::open() const {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  edges.reserve(3 * mesh->triangles().size());
  for (const glm::uvec3& triangle : mesh->triangles())
    for (int corner = 0; corner < 3; ++corner)
      edges.emplace_back(std::minmax(triangle[corner], triangle[(corner + 1) % 3]));
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t next = i + 1;
    while (next < edges.size() && edges[next] == edges[i]) ++next;
    if (next - i < 2) return true;
    i = next;
  }
  return false;
}

}  // namespace mesograin::heap

// Looks at every edge from both of its triangles, and whether all hangs together: two balls are convex at every edge. A
// closed surface that is convex at every edge can still wind around itself (a star polygon's prism does), which no mesh
// of a grain is known to do.
#include "scene/convexity.h"

#include <cstdint>
#include <glm/geometric.hpp>
#include <optional>
#include <unordered_map>
#include <vector>

#include "scene/pieces.h"
#include "scene/welding.h"

namespace mesograin::scene {
namespace {

// Of the mesh's reach: how far a neighbour's corner may stand above a triangle's plane.
constexpr double tolerance = 1e-5;

/// Of an edge, as one of its triangles goes along it.
std::uint64_t edge(std::uint32_t from, std::uint32_t to) { return std::uint64_t{from} << 32U | to; }

}  // namespace

bool is_convex(const Mesh& mesh) {
  const std::vector<std::uint32_t> numbers = welded(mesh, 0.1 * tolerance);
  const double allowed = tolerance * mesh.reach();
  struct Side {
    glm::dvec3 opposite;
    int triangles;
  };
  Pieces pieces(numbers.size());
  std::unordered_map<std::uint64_t, Side> sides;
  sides.reserve(3 * mesh.triangles().size());
  // Triangles without area, such as at a sphere's poles, are no part of the surface.
  const auto collapsed = [&](const glm::uvec3& triangle) {
    return numbers[triangle.x] == numbers[triangle.y] || numbers[triangle.y] == numbers[triangle.z] ||
           numbers[triangle.z] == numbers[triangle.x];
  };
  for (const glm::uvec3& triangle : mesh.triangles())
    for (int corner = 0; corner < 3 && !collapsed(triangle); ++corner) {
      const std::uint32_t from = numbers[triangle[corner]];
      const std::uint32_t to = numbers[triangle[(corner + 1) % 3]];
      Side& side = sides.try_emplace(edge(from, to), Side{{}, 0}).first->second;
      side.opposite = glm::dvec3(mesh.positions()[triangle[(corner + 2) % 3]]);
      ++side.triangles;
      pieces.join(from, to);
    }
  std::optional<std::uint32_t> piece;
  bool closed = true;
  bool flat = true;
  for (const glm::uvec3& triangle : mesh.triangles()) {
    const glm::dvec3 a(mesh.positions()[triangle.x]);
    const glm::dvec3 across =
        glm::cross(glm::dvec3(mesh.positions()[triangle.y]) - a, glm::dvec3(mesh.positions()[triangle.z]) - a);
    const double area = glm::length(across);
    if (area == 0.0 || collapsed(triangle)) continue;
    const std::uint32_t its = pieces.of(numbers[triangle.x]);
    if (piece.value_or(its) != its) return false;
    piece = its;
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t from = numbers[triangle[corner]];
      const std::uint32_t to = numbers[triangle[(corner + 1) % 3]];
      const auto other = sides.find(edge(to, from));
      if (other == sides.end()) {
        closed = false;
        continue;
      }
      if (other->second.triangles > 1) return false;
      const double above = glm::dot(other->second.opposite - a, across) / area;
      if (above > allowed) return false;
      if (above < -allowed) flat = false;
    }
  }
  return closed || flat;
}

}  // namespace mesograin::scene

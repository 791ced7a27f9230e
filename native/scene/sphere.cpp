// A UV sphere; the seam holds each vertex twice and a pole one for each of its faces, so that UVs are right there too.
#include "scene/sphere.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "base/error.h"

namespace mesograin::scene {

Mesh unit_sphere(int segments, int rings) {
  if (segments < 3 || rings < 2)
    throw Error("A sphere needs at least 3 segments and 2 rings; got {} and {}.", segments, rings);
  // A quad with corners on the sphere lies within it, by h^2 (1 + cos^2 latitude) / 3 on average for a half side of h.
  // The corners are lifted by that much, so that the quads neither shrink the sphere nor brighten its rim.
  const double half_side_u = std::numbers::pi / segments;
  const double half_side_v = 0.5 * std::numbers::pi / rings;
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;
  std::vector<glm::vec2> uvs;
  for (int ring = 0; ring <= rings; ++ring) {
    const double v = static_cast<double>(ring) / rings;
    const double z = ring == 0 ? -1.0 : ring == rings ? 1.0 : -std::cos(v * std::numbers::pi);
    const double distance = ring == 0 || ring == rings ? 0.0 : std::sin(v * std::numbers::pi);
    for (int segment = 0; segment <= segments; ++segment) {
      const double u = static_cast<double>(segment) / segments;
      const double longitude = 2.0 * std::numbers::pi * (segment % segments) / segments;
      const bool at_pole = ring == 0 || ring == rings;
      const glm::dvec3 normal(distance * std::cos(longitude), distance * std::sin(longitude), z);
      const double lift = (half_side_v * half_side_v + half_side_u * half_side_u * distance * distance) / 3.0;
      normals.emplace_back(normal);
      positions.emplace_back(normal * (1.0 + lift));
      uvs.emplace_back(at_pole ? u + 0.5 / segments : u, v);
    }
  }
  std::vector<glm::uvec3> triangles;
  const auto vertex = [&](int segment, int ring) {
    return static_cast<std::uint32_t>(ring * (segments + 1) + segment);
  };
  for (int ring = 0; ring < rings; ++ring)
    for (int segment = 0; segment < segments; ++segment) {
      const std::uint32_t low = vertex(segment, ring), low_next = vertex(segment + 1, ring);
      const std::uint32_t high = vertex(segment, ring + 1), high_next = vertex(segment + 1, ring + 1);
      if (ring + 1 == rings) {
        triangles.emplace_back(low, low_next, high);
      } else {
        if (ring > 0) triangles.emplace_back(low, low_next, high_next);
        triangles.emplace_back(low, high_next, high);
      }
    }
  return {std::move(positions), std::move(normals), std::move(triangles), std::move(uvs)};
}

}  // namespace mesograin::scene

// Checks a mesh's arrays and completes its normals.
#include "scene/mesh.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "base/error.h"

namespace mesograin::scene {
namespace {

template <typename Vector>
void require_finite(const std::vector<Vector>& values, const char* what) {
  for (std::size_t i = 0; i < values.size(); ++i)
    for (int axis = 0; axis < Vector::length(); ++axis)
      if (!std::isfinite(values[i][axis]))
        throw Error("A mesh's {} must be finite; number {} of vertex {} is {}.", what, axis, i, values[i][axis]);
}

std::vector<glm::vec3> smooth_normals(const std::vector<glm::vec3>& positions,
                                      const std::vector<glm::uvec3>& triangles) {
  std::vector<glm::dvec3> sums(positions.size(), glm::dvec3(0.0));
  for (const glm::uvec3& triangle : triangles) {
    const glm::dvec3 a(positions[triangle.x]);
    const glm::dvec3 twice_area_normal =
        glm::cross(glm::dvec3(positions[triangle.y]) - a, glm::dvec3(positions[triangle.z]) - a);
    for (int corner = 0; corner < 3; ++corner) sums[triangle[corner]] += twice_area_normal;
  }
  std::vector<glm::vec3> normals(positions.size());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double length = glm::length(sums[i]);
    // A vertex that no triangle with an area uses is never seen; any unit vector serves.
    normals[i] = length > 0.0 ? glm::vec3(sums[i] / length) : glm::vec3(0.0F, 0.0F, 1.0F);
  }
  return normals;
}

double radius_of_mean_chord(const std::vector<glm::vec3>& positions, const std::vector<glm::uvec3>& triangles,
                            const glm::dvec3& centre, double fallback) {
  double area = 0.0;
  double volume = 0.0;
  for (const glm::uvec3& triangle : triangles) {
    const glm::dvec3 a = glm::dvec3(positions[triangle.x]) - centre;
    const glm::dvec3 b = glm::dvec3(positions[triangle.y]) - centre;
    const glm::dvec3 c = glm::dvec3(positions[triangle.z]) - centre;
    area += 0.5 * glm::length(glm::cross(b - a, c - a));
    volume += glm::dot(a, glm::cross(b, c)) / 6.0;
  }
  // A closed mesh has at most the chords of the sphere around it; next to none means that it is a sheet.
  const double radius = area > 0.0 ? 3.0 * std::abs(volume) / area : 0.0;
  return radius > 1e-3 * fallback && radius < fallback ? radius : fallback;
}

}  // namespace

Mesh::Mesh(std::vector<glm::vec3> positions, std::vector<glm::vec3> normals, std::vector<glm::uvec3> triangles,
           std::vector<glm::vec2> uvs)
    : positions_(std::move(positions)),
      normals_(std::move(normals)),
      triangles_(std::move(triangles)),
      uvs_(std::move(uvs)) {
  if (positions_.empty() || triangles_.empty())
    throw Error("A mesh needs at least one triangle; got {} vertices and {} triangles.", positions_.size(),
                triangles_.size());
  for (std::size_t i = 0; i < triangles_.size(); ++i)
    for (int corner = 0; corner < 3; ++corner)
      if (triangles_[i][corner] >= positions_.size())
        throw Error("A mesh's indices must lie below its {} vertices; triangle {} names vertex {}.", positions_.size(),
                    i, triangles_[i][corner]);
  if (!normals_.empty() && normals_.size() != positions_.size())
    throw Error("A mesh needs one normal for each of its {} positions; got {}.", positions_.size(), normals_.size());
  if (!uvs_.empty() && uvs_.size() != positions_.size())
    throw Error("A mesh needs one UV for each of its {} positions; got {}.", positions_.size(), uvs_.size());
  require_finite(positions_, "positions");
  require_finite(normals_, "normals");
  require_finite(uvs_, "UVs");
  if (normals_.empty()) normals_ = smooth_normals(positions_, triangles_);

  lower_ = upper_ = positions_.front();
  for (const glm::vec3& position : positions_) {
    lower_ = glm::min(lower_, position);
    upper_ = glm::max(upper_, position);
  }
  const glm::dvec3 half = 0.5 * (glm::dvec3(upper_) - glm::dvec3(lower_));
  const glm::dvec3 middle = glm::dvec3(lower_) + half;
  for (const glm::vec3& position : positions_) reach_ = std::max(reach_, glm::length(glm::dvec3(position) - middle));
  equivalent_radius_ = radius_of_mean_chord(positions_, triangles_, middle, glm::length(half));
}

}  // namespace mesograin::scene

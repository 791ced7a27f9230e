// A closed mesh in double precision, with a plain tree of boxes of its own: lengths are in mean free paths.
#pragma once

#include <array>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "scene/mesh.h"

namespace mesograin::referee {

struct MeshHit {
  double distance;
  glm::dvec3 normal;  ///< of the flat triangle, out of the body
};

class MeshBody {
 public:
  /// `sigma_t` is per unit of the world that `to_world` leads to.
  MeshBody(const scene::Mesh& mesh, const glm::dmat4& to_world, double sigma_t);

  /// What lies ahead, from either side.
  std::optional<MeshHit> first_hit(const glm::dvec3& origin, const glm::dvec3& direction) const;

  /// The surface is at least so far away.
  double clearance(const glm::dvec3& place) const;

  const glm::dvec3& lower() const { return lower_; }
  const glm::dvec3& upper() const { return upper_; }
  const std::vector<std::array<glm::dvec3, 3>>& triangles() const { return triangles_; }

 private:
  struct Node {
    glm::dvec3 lower, upper;
    std::size_t first, count;  ///< triangles of a leaf, or the second child (the first one is next) and 0
  };

  void build(std::size_t first, std::size_t last);
  void measure_clearance();
  std::size_t cell(const glm::dvec3& place) const;

  std::vector<std::array<glm::dvec3, 3>> triangles_;
  std::vector<Node> nodes_;
  glm::dvec3 lower_{0}, upper_{0};
  double shortest_ = 0;  // no triangle is met at less
  static constexpr int cells_ = 48;
  glm::dvec3 cell_size_{1};
  std::vector<float> clearances_;
};

}  // namespace mesograin::referee

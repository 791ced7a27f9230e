// The three bodies photons walk in; lengths are in mean free paths, normals point out of the body.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace mesograin::referee {

/// What every body answers: `inside(p)`, the distance along a ray to its surface, and the outward normal there.
struct HalfSpace {  ///< z > 0
  bool inside(const glm::dvec3& p) const { return p.z > 0; }
  double distance_to_surface(const glm::dvec3& p, const glm::dvec3& direction) const { return -p.z / direction.z; }
  glm::dvec3 settle_on_surface(glm::dvec3& p, const glm::dvec3&) const {
    p.z = 0;
    return {0, 0, -1};
  }
};

struct Slab {  ///< 0 < z < thickness
  double thickness;

  bool inside(const glm::dvec3& p) const { return p.z > 0 && p.z < thickness; }
  double distance_to_surface(const glm::dvec3& p, const glm::dvec3& direction) const {
    return ((direction.z > 0 ? thickness : 0) - p.z) / direction.z;
  }
  glm::dvec3 settle_on_surface(glm::dvec3& p, const glm::dvec3& direction) const {
    p.z = direction.z > 0 ? thickness : 0;
    return {0, 0, direction.z > 0 ? 1 : -1};
  }
};

struct Sphere {  ///< centred at the origin
  double radius;

  bool inside(const glm::dvec3& p) const { return glm::dot(p, p) < radius * radius; }
  double distance_to_surface(const glm::dvec3& p, const glm::dvec3& direction) const {
    const double along = glm::dot(p, direction);
    const double room = std::max(0.0, radius * radius - glm::dot(p, p));
    return -along + std::sqrt(along * along + room);
  }
  glm::dvec3 settle_on_surface(glm::dvec3& p, const glm::dvec3&) const {
    const glm::dvec3 normal = glm::normalize(p);
    p = radius * normal;
    return normal;
  }
};

}  // namespace mesograin::referee

// A closed mesh that rays are traced in, by Embree; scaled to unit size, so that a grain of a micrometre is as exact as
// one of a kilometre.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "scene/mesh.h"

namespace mesograin::transport {

/// Where a ray meets the surface.
struct Hit {
  float distance;
  glm::vec3 normal;  ///< of the triangle, outwards, unit length
};

/// The surface's point that is nearest to some place.
struct Nearest {
  glm::vec3 point;
  float distance;
  glm::vec3 normal;  ///< of the triangle, outwards, unit length
};

/// All lengths and places are in the body's own space: the mesh stretched by `linear`, the middle of its own box at the
/// origin, nothing farther from there than 1, turned so that it fits into a small box.
class Body {
 public:
  /// Throws Error if the mesh has a hole, crosses itself or encloses no volume. Triangles may be wound either way
  /// round, all of them alike.
  explicit Body(const scene::Mesh& mesh, const glm::dmat3& linear = glm::dmat3(1.0));

  /// What lies ahead, from either side. No triangle is met at less than a millionth.
  std::optional<Hit> first_hit(const glm::vec3& origin, const glm::vec3& direction) const;

  /// Where a straight line that has just left the body enters it again.
  std::optional<glm::vec3> next_entry(glm::vec3 place, const glm::vec3& direction) const;

  /// Some point is nearer than `within`.
  Nearest nearest(const glm::vec3& place, float within = std::numeric_limits<float>::infinity()) const;

  bool contains(const glm::vec3& place) const;

  /// From the stretched mesh's axes to the body's: a turn.
  const glm::dmat3& axes() const { return axes_; }

  /// Scene units a unit of the body.
  double unit() const { return unit_; }

  const glm::vec3& lower() const { return lower_; }
  const glm::vec3& upper() const { return upper_; }
  const std::vector<glm::vec3>& positions() const { return positions_; }
  const std::vector<glm::uvec3>& triangles() const { return triangles_; }
  const std::vector<glm::vec3>& normals() const { return normals_; }  ///< a triangle's each, outwards, unit length
  double volume() const { return volume_; }
  double area() const { return area_; }

  /// Whether nothing that has left it meets it again, or next to nothing.
  bool convex() const { return convex_; }

 private:
  struct Device;

  void require_alternating_sides() const;

  std::vector<glm::vec3> positions_;
  std::vector<glm::uvec3> triangles_;
  std::vector<glm::vec3> normals_;  // a triangle's each
  glm::vec3 lower_{0.0F};
  glm::vec3 upper_{0.0F};
  glm::dmat3 axes_{1.0};
  double unit_ = 1.0;
  double volume_ = 0.0;
  double area_ = 0.0;
  bool convex_;
  std::shared_ptr<const Device> device_;
};

}  // namespace mesograin::transport

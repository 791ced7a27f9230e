// Ear clipping in the plane of the polygon's area vector (Newell's), good for the few corners that faces have.
#include "io/triangulate.h"

#include <cstddef>
#include <glm/geometric.hpp>

namespace mesograin::io {
namespace {

/// Twice the area vector; its direction is the polygon's normal whatever its shape.
glm::dvec3 area_vector(std::span<const glm::vec3> corners) {
  glm::dvec3 sum(0.0);
  const glm::dvec3 origin(corners[0]);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    sum += glm::cross(glm::dvec3(corners[i]) - origin, glm::dvec3(corners[i + 1]) - origin);
  return sum;
}

class Clipper {
 public:
  explicit Clipper(std::span<const glm::vec3> corners) : corners_(corners), normal_(area_vector(corners)) {
    for (std::uint32_t corner = 0; corner < corners.size(); ++corner) left_.push_back(corner);
  }

  std::vector<glm::uvec3> clip() {
    std::vector<glm::uvec3> triangles;
    while (left_.size() > 3) {
      const std::size_t ear = find_ear();
      triangles.push_back(triangle(ear));
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    triangles.push_back(triangle(1));
    return triangles;
  }

 private:
  glm::uvec3 triangle(std::size_t middle) const {
    const std::size_t count = left_.size();
    return {left_[(middle + count - 1) % count], left_[middle], left_[(middle + 1) % count]};
  }

  /// Positive where a, b, c turn the polygon's way.
  double turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const glm::dvec3 origin(corners_[a]);
    return glm::dot(normal_, glm::cross(glm::dvec3(corners_[b]) - origin, glm::dvec3(corners_[c]) - origin));
  }

  bool is_ear(const glm::uvec3& ear) const {
    if (turn(ear.x, ear.y, ear.z) <= 0.0) return false;
    for (const std::uint32_t corner : left_) {
      if (corner == ear.x || corner == ear.y || corner == ear.z) continue;
      if (turn(ear.x, ear.y, corner) >= 0.0 && turn(ear.y, ear.z, corner) >= 0.0 && turn(ear.z, ear.x, corner) >= 0.0)
        return false;
    }
    return true;
  }

  std::size_t find_ear() const {
    for (std::size_t middle = 1; middle < left_.size(); ++middle)
      if (is_ear(triangle(middle))) return middle;
    return is_ear(triangle(0)) ? 0 : 1;  // a polygon without an ear crosses itself or has no area
  }

  std::span<const glm::vec3> corners_;
  glm::dvec3 normal_;
  std::vector<std::uint32_t> left_;
};

}  // namespace

std::vector<glm::uvec3> triangulate(std::span<const glm::vec3> corners) {
  if (corners.size() == 3) return {{0, 1, 2}};
  return Clipper(corners).clip();
}

}  // namespace mesograin::io

// From the near plane to the far plane, in double precision.
#include "render/pixel_rays.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace mesograin::render {

PixelRays::PixelRays(const glm::dmat4& anchor_to_clip, const glm::dvec2& size, const glm::dvec2& jitter,
                     const Bounds& bounds)
    : clip_to_anchor_(glm::inverse(anchor_to_clip)),
      scale_(2.0 / size),
      offset_(1.0 / size - 1.0 - jitter),
      middle_(bounds.empty() ? glm::dvec3(0.0) : 0.5 * (bounds.lower + bounds.upper)),
      radius_(bounds.empty() ? 0.0 : 0.5 * glm::distance(bounds.lower, bounds.upper)) {}

PixelRay PixelRays::at(const glm::dvec2& pixel) const {
  const glm::dvec2 place = pixel * scale_ + offset_;
  const glm::dvec4 amid = place.x * clip_to_anchor_[0] + place.y * clip_to_anchor_[1] + clip_to_anchor_[3];
  const glm::dvec4 near_plane = amid - clip_to_anchor_[2];
  const glm::dvec4 far_plane = amid + clip_to_anchor_[2];
  const glm::dvec3 origin = glm::dvec3(near_plane) / near_plane.w;
  const glm::dvec3 way = glm::dvec3(far_plane) / far_plane.w - origin;
  const double length = glm::length(way);
  const glm::dvec3 direction = way / length;
  const double ahead = std::max(glm::dot(middle_ - origin, direction) - radius_, 0.0);
  return {glm::vec3(origin + ahead * direction), glm::vec3(direction), static_cast<float>(length - ahead)};
}

}  // namespace mesograin::render

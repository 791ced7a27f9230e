// From surface to surface: of each that is left the way from the origin counts, of each that is entered it counts less.
#include "render/straight_through.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <optional>

namespace mesograin::render {
namespace {

// Of a draw's radius: how far from where a ray met it before it may meet it again.
constexpr float clearance = 1e-4F;

// Behind more surfaces than these nothing is left.
constexpr int most_met = 64;

bool enters(const Draw& draw, const casting::Hit& hit, const glm::vec3& direction) {
  const glm::uvec3& corners = draw.source->triangles()[hit.triangle];
  const auto place = [&](int corner) { return glm::dvec3(draw.source->positions()[corners[corner]]); };
  const glm::dmat3 to_world(draw.object_to_world);
  const glm::dvec3 across = glm::cross(to_world * (place(1) - place(0)), to_world * (place(2) - place(0)));
  return (glm::dot(across, glm::dvec3(direction)) < 0.0) == (glm::determinant(to_world) > 0.0);
}

}  // namespace

glm::vec3 StraightThrough::Way::left() const {
  return glm::exp(-glm::max(depth + length * glm::max(inside, 0.0F), 0.0F));
}

const Draw* StraightThrough::thin(const casting::Hit& hit) const {
  const std::size_t in_arrays = content_.instances() != nullptr ? content_.instances()->count() : 0;
  if (hit.number < in_arrays) return nullptr;
  const Draw& draw = content_.draws()[hit.group];
  return draw.material->shows_behind() ? &draw : nullptr;
}

void StraightThrough::go_on(const Draw& draw, const casting::Hit& hit, Way& way, casting::SingleRay& ray) const {
  way.length += hit.distance;
  const glm::vec3 sigma_t(draw.look.scale * (draw.look.sigma_a + draw.look.sigma_s));
  const float sign = enters(draw, hit, ray.direction) ? 1.0F : -1.0F;
  way.inside += sign * sigma_t;
  way.depth -= sign * way.length * sigma_t;
  ray.origin += hit.distance * ray.direction;
  ray.farthest -= hit.distance;
  ray.from = hit.number;
  ray.own = clearance * static_cast<float>(draw.radius);
}

glm::vec3 StraightThrough::left(casting::SingleRay ray) const {
  Way way;
  for (int met = 0; met < most_met; ++met) {
    const std::optional<casting::Hit> hit = cast_.first_hit(ray);
    if (!hit) {
      const bool in_light = std::isfinite(ray.farthest);
      if (!in_light && way.inside != glm::min(way.inside, 0.0F)) return glm::vec3(0.0F);
      if (in_light) way.length += ray.farthest;
      return way.left();
    }
    const Draw* draw = thin(*hit);
    if (draw == nullptr) return glm::vec3(0.0F);
    go_on(*draw, *hit, way, ray);
  }
  return glm::vec3(0.0F);
}

std::optional<casting::Hit> StraightThrough::stopped(casting::SingleRay ray, float drawn) const {
  Way way;
  std::optional<casting::Hit> entered;  // its distance from where the ray begins
  for (int met = 0; met < most_met; ++met) {
    std::optional<casting::Hit> hit = cast_.first_hit(ray);
    if (!hit) return way.inside != glm::min(way.inside, 0.0F) ? entered : std::nullopt;
    Way here = way;
    here.length += hit->distance;
    const glm::vec3 left = here.left();
    if (entered && (left.r + left.g + left.b) / 3.0F <= drawn) return entered;
    const Draw* draw = thin(*hit);
    if (draw != nullptr) go_on(*draw, *hit, way, ray);
    hit->distance = here.length;
    if (draw == nullptr) return hit;
    // What it comes into last stops it, if anything does.
    if (way.depth != glm::max(way.depth, here.depth)) entered = hit;
  }
  return entered;
}

}  // namespace mesograin::render

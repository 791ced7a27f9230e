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

// Of light through glass, that it has a logarithm.
constexpr float least_passed = 1e-30F;

// Behind more surfaces than these nothing is left.
constexpr int most_met = 64;

/// The cosine between the outward normal of what was met and the way back: positive where a ray comes in.
float cosine_at(const Draw& draw, const casting::Hit& hit, const glm::vec3& direction) {
  const glm::uvec3& corners = draw.source->triangles()[hit.triangle];
  const auto place = [&](int corner) { return glm::dvec3(draw.source->positions()[corners[corner]]); };
  const glm::dmat3 to_world(draw.object_to_world);
  const glm::dvec3 across = glm::cross(to_world * (place(1) - place(0)), to_world * (place(2) - place(0)));
  const double outwards = glm::determinant(to_world) < 0.0 ? -1.0 : 1.0;
  return static_cast<float>(-outwards * glm::dot(glm::normalize(across), glm::dvec3(direction)));
}

void move_to(const Draw& draw, const casting::Hit& hit, casting::SingleRay& ray) {
  ray.origin += hit.distance * ray.direction;
  ray.farthest -= hit.distance;
  ray.from = hit.number;
  ray.own = clearance * static_cast<float>(draw.radius);
}

}  // namespace

glm::vec3 StraightThrough::Way::left() const {
  return glm::exp(-glm::max(depth + length * glm::max(inside, 0.0F), 0.0F));
}

std::optional<bool> StraightThrough::go_on(const casting::Hit& hit, Way& way, casting::SingleRay& ray) const {
  const std::size_t in_arrays = content_.instances() != nullptr ? content_.instances()->count() : 0;
  if (hit.number < in_arrays) return std::nullopt;
  const Draw& draw = content_.draws()[hit.group];
  if (exchange_.any_panes() && exchange_.roles()[in_arrays + hit.group].pane) return go_on_pane(draw, hit, way, ray);
  if (exchange_.tells_straight() || !draw.material->shows_behind()) return std::nullopt;
  return go_on_thin(draw, hit, way, ray);
}

bool StraightThrough::go_on_thin(const Draw& draw, const casting::Hit& hit, Way& way, casting::SingleRay& ray) const {
  way.length += hit.distance;
  const glm::vec3 sigma_t(draw.look.scale * (draw.look.sigma_a + draw.look.sigma_s));
  const bool enters = cosine_at(draw, hit, ray.direction) > 0.0F;
  const float sign = enters ? 1.0F : -1.0F;
  way.inside += sign * sigma_t;
  way.depth -= sign * way.length * sigma_t;
  move_to(draw, hit, ray);
  return enters;
}

bool StraightThrough::go_on_pane(const Draw& draw, const casting::Hit& hit, Way& way, casting::SingleRay& ray) const {
  way.length += hit.distance;
  const float cosine = cosine_at(draw, hit, ray.direction);
  move_to(draw, hit, ray);
  if (!(cosine > 0.0F)) return false;
  const std::optional<casting::Hit> other = cast_.first_hit(ray);
  if (!other || other->number != hit.number) return true;
  const glm::vec3 passed = heap::sheet(heap::glass_of(draw.look), cosine, other->distance).passed;
  way.depth -= glm::log(glm::max(passed, least_passed));
  way.length += other->distance;
  move_to(draw, *other, ray);
  return true;
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
    if (!go_on(*hit, way, ray)) return glm::vec3(0.0F);
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
    const std::optional<bool> enters = go_on(*hit, way, ray);
    hit->distance = here.length;
    if (!enters) return hit;
    // What it comes into last stops it, if anything does.
    if (*enters) entered = hit;
  }
  return entered;
}

}  // namespace mesograin::render

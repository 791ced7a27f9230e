// Fits a picture around what is lit, as deep as the scene: an orthographic one for a light that is endlessly far.
#include "render/shadow_maps.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "render/device_layout.h"

namespace mesograin::render {
namespace {

// Of the scene's size: what single precision may move a surface by on its way through two matrices.
constexpr double rounding = 2e-6;

glm::dmat3 light_axes(const glm::dvec3& to_light) {
  const glm::dvec3 helper = std::abs(to_light.x) < 0.5 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
  const glm::dvec3 x_axis = glm::normalize(glm::cross(helper, to_light));
  return glm::transpose(glm::dmat3(x_axis, glm::cross(to_light, x_axis), to_light));
}

struct Projection {
  glm::dmat4 anchor_to_clip;
  double texel;  // its width, in scene units; of a place, at distance 1
};

// Of light space.
Bounds turned(const Bounds& box, const glm::dmat3& axes) {
  Bounds result;
  for (unsigned corner = 0; corner < 8 && !box.empty(); ++corner) {
    const glm::bvec3 high((corner & 1U) != 0, (corner & 2U) != 0, (corner & 4U) != 0);
    result.include(axes * glm::mix(box.lower, box.upper, high), 0.0);
  }
  return result;
}

Projection fit_parallel(const glm::dvec3& to_light, const Receivers& receivers, const Bounds& casters,
                        const Bounds& over_ground, int resolution, const glm::dvec2& jitter) {
  const glm::dmat3 axes = light_axes(to_light);
  Bounds lit;
  for (const glm::vec4& ball : receivers.grains) lit.include(axes * glm::dvec3(ball), ball.w);
  Bounds ground;
  for (const glm::vec4& ball : receivers.ground) ground.include(axes * glm::dvec3(ball), ball.w);
  const Bounds over = turned(over_ground, axes);
  ground.lower = glm::max(ground.lower, glm::dvec3(over.lower.x, over.lower.y, -1e300));
  ground.upper = glm::min(ground.upper, glm::dvec3(over.upper.x, over.upper.y, 1e300));
  if (ground.lower.x < ground.upper.x && ground.lower.y < ground.upper.y) {
    lit.lower = glm::min(lit.lower, ground.lower);
    lit.upper = glm::max(lit.upper, ground.upper);
  }
  const glm::dvec2 lower(lit.lower);
  const glm::dvec2 upper(lit.upper);
  const Bounds all = turned(casters, axes);
  const double nearest = all.upper.z;
  const double farthest = all.lower.z;
  // Two texels more than needed leave room for the jitter.
  const double half = 0.5 * std::max({upper.x - lower.x, upper.y - lower.y, 1e-30}) * (1.0 + 4.0 / resolution);
  const double texel = 2.0 * half / resolution;
  const glm::dvec2 middle = 0.5 * (lower + upper) + (jitter - 0.5) * texel;
  const double depth = 0.51 * std::max(nearest - farthest, 1e-30);
  glm::dmat4 place(axes);
  place[3] = glm::dvec4(-middle, -0.5 * (nearest + farthest), 1.0);
  return {glm::scale(glm::dmat4(1.0), glm::dvec3(1.0 / half, 1.0 / half, -1.0 / depth)) * place, texel};
}

// A light amid what it lights sees no more than this of it, the rest is unshaded.
constexpr double widest_slope = 4.0;

Projection fit_place(const glm::dvec3& place, const Receivers& receivers, const Bounds& casters,
                     const Bounds& over_ground, int resolution, const glm::dvec2& jitter) {
  Bounds lit;
  for (const glm::vec4& ball : receivers.grains) lit.include(glm::dvec3(ball), ball.w);
  // Seen from a place, the ground is dark somewhere around what stands on it.
  for (const glm::vec4& ball : receivers.ground) lit.include(glm::dvec3(ball), ball.w);
  if (!over_ground.empty()) {
    const glm::dvec3 around = over_ground.upper - over_ground.lower;
    lit.lower = glm::max(lit.lower, over_ground.lower - 4.0 * around);
    lit.upper = glm::min(lit.upper, over_ground.upper + 4.0 * around);
  }
  const glm::dvec3 middle = lit.empty() ? place - glm::dvec3(0.0, 0.0, 1.0) : 0.5 * (lit.lower + lit.upper);
  const glm::dvec3 away = middle - place;
  const double distance = glm::length(away);
  const glm::dvec3 forward = distance > 0.0 ? away / distance : glm::dvec3(0.0, 0.0, -1.0);
  const double radius = lit.empty() ? 1.0 : 0.5 * glm::length(lit.upper - lit.lower);
  const double slope = distance > radius
                           ? std::min(radius / std::sqrt(distance * distance - radius * radius), widest_slope)
                           : widest_slope;
  const double half = std::max(slope, 1e-6) * (1.0 + 4.0 / resolution);
  double farthest = 0.0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const glm::bvec3 high((corner & 1U) != 0, (corner & 2U) != 0, (corner & 4U) != 0);
    farthest = std::max(farthest, glm::distance(place, glm::mix(casters.lower, casters.upper, high)));
  }
  farthest = std::max(1.01 * farthest, 1e-30);
  const double nearest = 1e-4 * farthest;
  glm::dmat4 view(light_axes(-forward));
  view = view * glm::translate(glm::dmat4(1.0), -place);
  const double texel = 2.0 * half / resolution;
  const glm::dvec2 moved = (jitter - 0.5) * texel * nearest;
  const double edge = half * nearest;
  return {glm::frustum(moved.x - edge, moved.x + edge, moved.y - edge, moved.y + edge, nearest, farthest) * view,
          texel};
}

}  // namespace

bool ShadowMaps::update(const std::vector<ShadowEye>& eyes, const Receivers& receivers, const Bounds& casters,
                        const Bounds& over_ground, int resolution, const glm::dvec2& jitter, const DrawCasters& draw) {
  const auto layers = static_cast<int>(eyes.size());
  if (!maps_ || maps_->layers() != layers || maps_->width() != resolution) {
    maps_.emplace(GL_RG32F, resolution, resolution, layers);
    depth_.emplace(GL_DEPTH_COMPONENT32F, resolution, resolution);
  }
  const glm::dmat4 to_unit =
      glm::translate(glm::dmat4(1.0), glm::dvec3(0.5)) * glm::scale(glm::dmat4(1.0), glm::dvec3(0.5));
  const double error = rounding * glm::length(casters.upper - casters.lower);
  std::vector<layout::ShadowView> views;
  for (int layer = 0; layer < layers; ++layer) {
    const ShadowEye& eye = eyes[static_cast<std::size_t>(layer)];
    const auto fit = eye.w > 0.0 ? fit_place : fit_parallel;
    const Projection view = fit(glm::dvec3(eye), receivers, casters, over_ground, resolution, jitter);
    if (!draw(view.anchor_to_clip, eye, *maps_, layer, *depth_)) return false;
    views.push_back({glm::mat4(to_unit * view.anchor_to_clip), glm::vec4(eye), glm::vec4(view.texel, error, 0.0, 0.0)});
  }
  views_.emplace(views);
  return true;
}

void ShadowMaps::bind(const gl::Program& program) const {
  if (!views_) return;
  program.set("shadow_maps", *maps_);
  views_->bind_storage(layout::SHADOW_VIEWS_BINDING);
}

}  // namespace mesograin::render

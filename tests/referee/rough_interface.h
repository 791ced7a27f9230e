// An interface of relative index eta that is smooth, or made of GGX facets among which light goes on until it leaves
// them: nothing is lost.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <optional>

#include "directions.h"
#include "interface.h"
#include "rng.h"

namespace mesograin::referee {

/// Light walks on a random height field (Heitz et al., "Multiple-scattering microfacet BSDFs with the Smith model",
/// 2016) whose heights are uniform: they are told by the share of the surface that is lower.
struct RoughInterface {
  Interface smooth;
  double alpha = 0;

  bool matched() const { return smooth.matched(); }
  bool rough() const { return alpha > 0 && !matched(); }

  /// Where light goes that meets the surface; `normal` points out of the body. `facets`, if any: how many of a rough
  /// one it has met.
  glm::dvec3 beyond(const glm::dvec3& direction, const glm::dvec3& normal, Rng& rng, int* facets = nullptr) const {
    if (facets != nullptr) *facets = 0;
    if (matched()) return direction;
    if (!rough()) return beyond_facet(direction, normal, rng);
    glm::dvec3 first, second;
    frame(normal, first, second);
    glm::dvec3 local(glm::dot(first, direction), glm::dot(second, direction), glm::dot(normal, direction));
    bool outside = local.z < 0;
    double lower = outside ? 1 : 0;
    // To light inside the facets lie upside down.
    while (const std::optional<double> met =
               outside ? next_height(local, lower, rng) : next_height(-local, 1 - lower, rng)) {
      lower = outside ? *met : 1 - *met;
      const glm::dvec3 facet = visible_facet(outside ? -local : local, rng);
      local = glm::normalize(beyond_facet(local, facet, rng));
      outside = glm::dot(local, facet) > 0;
      if (facets != nullptr) ++*facets;
    }
    return glm::normalize(local.x * first + local.y * second + local.z * normal);
  }

  /// What one of a rough surface's facets reflects outside, 1/sr times the cosine of the light that comes from
  /// `to_light` (Walter et al., "Microfacet models for refraction through rough surfaces", 2007, eq 20 and 33; heights
  /// that shadow and mask alike: Heitz, "Understanding the masking-shadowing function", 2014, eq 99).
  double reflected_once(const glm::dvec3& to_light, const glm::dvec3& to_viewer, const glm::dvec3& normal) const {
    const double in = glm::dot(to_light, normal), out = glm::dot(to_viewer, normal);
    if (!rough() || in <= 0 || out <= 0) return 0;
    const glm::dvec3 half = glm::normalize(to_light + to_viewer);
    const double square = alpha * alpha, upright = glm::dot(half, normal);
    const double spread = upright * upright * (square - 1) + 1;
    const double density = square / (std::numbers::pi * spread * spread);
    const auto hidden = [square](double cosine) {
      return 0.5 * (std::sqrt(1 + square * (1 - cosine * cosine) / (cosine * cosine)) - 1);
    };
    return smooth.reflectance_from_outside(glm::dot(half, to_light)) * density / (1 + hidden(in) + hidden(out)) /
           (4 * out);
  }

 private:
  glm::dvec3 beyond_facet(const glm::dvec3& direction, const glm::dvec3& normal, Rng& rng) const {
    const double cosine = std::clamp(glm::dot(normal, direction), -1.0, 1.0);
    const bool inside = cosine > 0;
    const double reflectance =
        inside ? smooth.reflectance_from_inside(cosine) : smooth.reflectance_from_outside(-cosine);
    if (rng.uniform() < reflectance) return direction - 2 * cosine * normal;
    return refract(direction, inside ? -normal : normal, inside ? 1 / smooth.eta : smooth.eta);
  }

  /// Where light on its way along `direction` meets a facet, or nothing: it is above them all (section 4.3 there).
  std::optional<double> next_height(const glm::dvec3& direction, double lower, Rng& rng) const {
    constexpr double along_surface = 1e-6;
    if (std::abs(direction.z) < along_surface) return lower;
    const double tangent_square = (1 - direction.z) * (1 + direction.z) / (direction.z * direction.z);
    const double root = std::sqrt(1 + alpha * alpha * tangent_square);
    // Smith's Lambda of GGX (Heitz, "Understanding the masking-shadowing function", 2014, equation 72), either way.
    const double lambda = 0.5 * (std::copysign(root, direction.z) - 1);
    const double left = rng.uniform_positive();
    if (direction.z > 0 && (lambda <= 0 || left <= std::pow(lower, lambda))) return std::nullopt;
    return std::min(lower * std::pow(left, -1 / lambda), 1.0);
  }

  /// The normal of a facet as likely as it is seen from `view`, which may lie below the horizon (Heitz, "Sampling the
  /// GGX distribution of visible normals", 2018).
  glm::dvec3 visible_facet(const glm::dvec3& view, Rng& rng) const {
    const glm::dvec3 stretched = glm::normalize(glm::dvec3(alpha * view.x, alpha * view.y, view.z));
    const double across = stretched.x * stretched.x + stretched.y * stretched.y;
    const glm::dvec3 first =
        across > 0 ? glm::dvec3(-stretched.y, stretched.x, 0) / std::sqrt(across) : glm::dvec3(1, 0, 0);
    const glm::dvec3 second = glm::cross(stretched, first);
    double square;
    const glm::dvec2 disc = sample_disc(rng, square);
    const double share = 0.5 * (1 + stretched.z);
    const double rest = std::sqrt(1 - disc.x * disc.x);
    const double up = (1 - share) * rest + share * disc.y;
    const glm::dvec3 normal =
        disc.x * first + up * second + std::sqrt(std::max(0.0, 1 - disc.x * disc.x - up * up)) * stretched;
    return glm::normalize(glm::dvec3(alpha * normal.x, alpha * normal.y, std::max(1e-9, normal.z)));
  }
};

}  // namespace mesograin::referee

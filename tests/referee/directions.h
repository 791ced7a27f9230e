// Directions drawn at random: isotropic, Henyey-Greenstein and cosine-weighted, without trigonometric functions.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <numbers>

#include "rng.h"

namespace mesograin::referee {

/// A point of the open unit disc without its centre, by rejection; `square` receives its squared distance from the
/// centre.
inline glm::dvec2 sample_disc(Rng& rng, double& square) {
  while (true) {
    const glm::dvec2 point(2 * rng.uniform() - 1, 2 * rng.uniform() - 1);
    square = point.x * point.x + point.y * point.y;
    if (square < 1 && square > 0) return point;
  }
}

/// Uniform on the unit sphere (Marsaglia, "Choosing a point from the surface of a sphere", 1972).
inline glm::dvec3 sample_isotropic(Rng& rng) {
  double square;
  const glm::dvec2 point = sample_disc(rng, square);
  const double factor = 2 * std::sqrt(1 - square);
  return {factor * point.x, factor * point.y, 1 - 2 * square};
}

/// Two unit vectors that make a right-handed frame with `axis` (Duff et al., "Building an orthonormal basis,
/// revisited", 2017).
inline void frame(const glm::dvec3& axis, glm::dvec3& first, glm::dvec3& second) {
  const double sign = std::copysign(1.0, axis.z);
  const double a = -1 / (sign + axis.z);
  const double b = axis.x * axis.y * a;
  first = {1 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x};
  second = {b, sign + axis.y * axis.y * a, -axis.y};
}

/// The direction at `cosine` from `axis`, its azimuth uniform.
inline glm::dvec3 sample_cone(const glm::dvec3& axis, double cosine, Rng& rng) {
  double square;
  const glm::dvec2 point = sample_disc(rng, square);
  const double factor = std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine)) / square);
  glm::dvec3 first, second;
  frame(axis, first, second);
  return cosine * axis + factor * point.x * first + factor * point.y * second;
}

/// Cosine-weighted about `normal` (Malley's method).
inline glm::dvec3 sample_cosine(const glm::dvec3& normal, Rng& rng) {
  return sample_cone(normal, std::sqrt(rng.uniform_positive()), rng);
}

/// Density of the Henyey-Greenstein phase function at the cosine between the directions before and after (1/sr).
/// Henyey and Greenstein, "Diffuse radiation in the galaxy", 1941, eq 2.
inline double phase(double cosine, double g) {
  const double denominator = (1 - g) * (1 - g) + 2 * g * (1 - cosine);
  return (1 - g) * (1 + g) / (4 * std::numbers::pi * denominator * std::sqrt(denominator));
}

/// The direction after a scattering (Witt, "Multiple scattering in reflection nebulae", 1977: the inverted distribution
/// function).
inline glm::dvec3 sample_phase(const glm::dvec3& direction, double g, Rng& rng) {
  if (std::abs(g) < 1e-6)
    return sample_isotropic(rng);  // the inversion divides by g; the error made here is below 1.5 g
  const double ratio = (1 - g) * (1 + g) / (1 - g + 2 * g * rng.uniform());
  const double cosine = std::clamp((1 + g * g - ratio * ratio) / (2 * g), -1.0, 1.0);
  return sample_cone(direction, cosine, rng);
}

}  // namespace mesograin::referee

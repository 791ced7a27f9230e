// A smooth interface of relative index eta (inside over outside): Fresnel reflectance, refraction, reflection.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace mesograin::referee {

/// Unpolarised Fresnel reflectance; `relative` is the index on the far side over the index on the near side, `cosine`
/// (>= 0) is on the near side. Born and Wolf, "Principles of optics", 1.5.2 eq 20-21.
inline double fresnel(double cosine, double relative) {
  const double far_sine_square = (1 - cosine) * (1 + cosine) / (relative * relative);
  if (far_sine_square >= 1) return 1;
  const double far_cosine = std::sqrt(1 - far_sine_square);
  const double senkrecht = (cosine - relative * far_cosine) / (cosine + relative * far_cosine);
  const double parallel = (relative * cosine - far_cosine) / (relative * cosine + far_cosine);
  return 0.5 * (senkrecht * senkrecht + parallel * parallel);
}

struct Interface {
  double eta = 1;  ///< index inside over index outside; 1 is no interface at all

  bool matched() const { return eta == 1; }

  /// Reflectance met from inside, at the cosine inside.
  double reflectance_from_inside(double cosine) const { return matched() ? 0 : fresnel(cosine, 1 / eta); }

  /// Reflectance met from outside, at the cosine outside.
  double reflectance_from_outside(double cosine) const { return matched() ? 0 : fresnel(cosine, eta); }
};

/// The direction beyond an interface; `normal` points to the near side, `relative` is far over near index.
/// The caller has made sure that there is no total reflection.
inline glm::dvec3 refract(const glm::dvec3& direction, const glm::dvec3& normal, double relative) {
  const double cosine = -glm::dot(direction, normal);
  const double far_cosine = std::sqrt(std::max(0.0, 1 - (1 - cosine) * (1 + cosine) / (relative * relative)));
  return direction / relative + (cosine / relative - far_cosine) * normal;
}

}  // namespace mesograin::referee

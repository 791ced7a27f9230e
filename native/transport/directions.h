// Directions: drawn evenly, drawn by a phase function, refracted and reflected.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numbers>

namespace mesograin::transport {

/// Uniform on the unit sphere for u and v uniform in [0, 1).
inline glm::vec3 isotropic(float u, float v) {
  const float z = 1.0F - 2.0F * u;
  const float sine = std::sqrt(std::max(0.0F, (1.0F - z) * (1.0F + z)));
  const float azimuth = 2.0F * std::numbers::pi_v<float> * v;
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), z};
}

/// Two unit vectors that make a right-handed frame with `axis` (Duff et al., "Building an orthonormal basis,
/// revisited", JCGT 2017).
inline void make_frame(const glm::vec3& axis, glm::vec3& first, glm::vec3& second) {
  const float sign = std::copysign(1.0F, axis.z);
  const float a = -1.0F / (sign + axis.z);
  const float b = axis.x * axis.y * a;
  first = {1.0F + sign * axis.x * axis.x * a, sign * b, -sign * axis.x};
  second = {b, sign + axis.y * axis.y * a, -axis.y};
}

/// About a normal, the likelier the larger its cosine.
inline glm::vec3 cosine_lobe(const glm::vec3& normal, float u, float v) {
  const float cosine = std::sqrt(1.0F - u);
  const float sine = std::sqrt(std::max(0.0F, (1.0F - cosine) * (1.0F + cosine)));
  const float azimuth = 2.0F * std::numbers::pi_v<float> * v;
  glm::vec3 first, second;
  make_frame(normal, first, second);
  return cosine * normal + sine * (std::cos(azimuth) * first + std::sin(azimuth) * second);
}

/// The direction after a scattering with Henyey and Greenstein's phase function (its inverted distribution: Witt,
/// "Multiple scattering in reflection nebulae", 1977, eq. 19).
inline glm::vec3 scattered(const glm::vec3& direction, float g, float u, float v) {
  if (std::abs(g) < 1e-3F) return isotropic(u, v);
  const float ratio = (1.0F - g) * (1.0F + g) / (1.0F - g + 2.0F * g * u);
  const float cosine = std::clamp((1.0F + g * g - ratio * ratio) / (2.0F * g), -1.0F, 1.0F);
  const float sine = std::sqrt((1.0F - cosine) * (1.0F + cosine));
  const float azimuth = 2.0F * std::numbers::pi_v<float> * v;
  glm::vec3 first, second;
  make_frame(direction, first, second);
  return glm::normalize(cosine * direction + sine * (std::cos(azimuth) * first + std::sin(azimuth) * second));
}

/// Beyond an interface whose `normal` points to the near side; `index` is the far side's over the near side's. There
/// must be no total reflection.
inline glm::vec3 refracted(const glm::vec3& direction, const glm::vec3& normal, float index) {
  const float cosine = -glm::dot(direction, normal);
  const float far_cosine = std::sqrt(std::max(0.0F, 1.0F - (1.0F - cosine) * (1.0F + cosine) / (index * index)));
  return glm::normalize(direction / index + (cosine / index - far_cosine) * normal);
}

}  // namespace mesograin::transport

// Heitz' projection of the hemisphere.
#include "physics/visible_normals.h"

#include <algorithm>
#include <cmath>

#include "physics/physics.h"

namespace mesograin::physics {

glm::dvec3 visible_normal(const glm::dvec3& view, double alpha, double radius, double azimuth) {
  const glm::dvec3 stretched = glm::normalize(glm::dvec3(alpha * view.x, 0.0, view.z));
  const glm::dvec3 tangent(0.0, 1.0, 0.0);
  const glm::dvec3 bitangent = glm::cross(stretched, tangent);
  const double t1 = radius * std::cos(azimuth);
  const double blend = 0.5 * (1.0 + stretched.z);
  const double t2 = (1.0 - blend) * sine_of_cosine(t1) + blend * radius * std::sin(azimuth);
  const glm::dvec3 normal =
      t1 * tangent + t2 * bitangent + std::sqrt(std::max(0.0, 1.0 - t1 * t1 - t2 * t2)) * stretched;
  return glm::normalize(glm::dvec3(alpha * normal.x, alpha * normal.y, std::max(1e-12, normal.z)));
}

}  // namespace mesograin::physics

// Solid angles of the octahedral map's texels, by finer ones.
#include "transport/octahedron.h"

#include <numbers>

namespace mesograin::transport {

std::array<float, octahedron_texels> octahedron_solid_angles() {
  constexpr int finer = 8;
  constexpr int across = octahedron_side * finer;
  std::array<float, octahedron_texels> angles{};
  double sum = 0.0;
  for (int y = 0; y < across; ++y)
    for (int x = 0; x < across; ++x) {
      // A face of the octahedron lies 1/sqrt(3) from the middle: a piece of it is seen as dA cos/r^2 ~ 1/r^3.
      const float u = 2.0F * (static_cast<float>(x) + 0.5F) / across - 1.0F;
      const float v = 2.0F * (static_cast<float>(y) + 0.5F) / across - 1.0F;
      const float height = 1.0F - std::abs(u) - std::abs(v);
      const float fold = std::fmax(-height, 0.0F);
      const float distance = glm::length(glm::vec3(u - std::copysign(fold, u), v - std::copysign(fold, v), height));
      const float angle = 1.0F / (distance * distance * distance);
      angles[y / finer * octahedron_side + x / finer] += angle;
      sum += angle;
    }
  for (float& angle : angles) angle *= static_cast<float>(4.0 * std::numbers::pi / sum);
  return angles;
}

}  // namespace mesograin::transport

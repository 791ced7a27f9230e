// Maps of fewer texels, and solid angles of texels, by finer ones.
#include "transport/octahedron.h"

#include <cstddef>
#include <numbers>

namespace mesograin::transport {

std::vector<float> octahedron_map(const std::vector<float>& values, int side) {
  if (side == octahedron_side) return values;
  std::vector<float> map;
  map.reserve(octahedron_texels);
  const auto at = [&](int x, int y) { return values[static_cast<std::size_t>(octahedron_texel(x, y, side))]; };
  const auto place = [&](int texel) {
    return (static_cast<float>(texel) + 0.5F) * static_cast<float>(side) / octahedron_side - 0.5F;
  };
  for (int row = 0; row < octahedron_side; ++row)
    for (int column = 0; column < octahedron_side; ++column) {
      const float x = std::floor(place(column)), y = std::floor(place(row));
      const int left = static_cast<int>(x), above = static_cast<int>(y);
      const float along = place(column) - x;
      const float upper = std::lerp(at(left, above), at(left + 1, above), along);
      const float lower = std::lerp(at(left, above + 1), at(left + 1, above + 1), along);
      map.push_back(std::lerp(upper, lower, place(row) - y));
    }
  return map;
}

std::vector<float> octahedron_solid_angles(int side) {
  constexpr int finer = 8;
  const int across = side * finer;
  std::vector<float> angles(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), 0.0F);
  double sum = 0.0;
  for (int y = 0; y < across; ++y)
    for (int x = 0; x < across; ++x) {
      // A face of the octahedron lies 1/sqrt(3) from the middle: a piece of it is seen as dA cos/r^2 ~ 1/r^3.
      const float u = 2.0F * (static_cast<float>(x) + 0.5F) / static_cast<float>(across) - 1.0F;
      const float v = 2.0F * (static_cast<float>(y) + 0.5F) / static_cast<float>(across) - 1.0F;
      const float height = 1.0F - std::abs(u) - std::abs(v);
      const float fold = std::fmax(-height, 0.0F);
      const float distance = glm::length(glm::vec3(u - std::copysign(fold, u), v - std::copysign(fold, v), height));
      const float angle = 1.0F / (distance * distance * distance);
      const int texel = y / finer * side + x / finer;
      angles[static_cast<std::size_t>(texel)] += angle;
      sum += angle;
    }
  for (float& angle : angles) angle *= static_cast<float>(4.0 * std::numbers::pi / sum);
  return angles;
}

}  // namespace mesograin::transport

// Light that depends on the direction of a surface's normal: spherical harmonics to order 1, written as mean + slope .
// n.
#pragma once

#include <array>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

namespace mesograin::heap {

/// For red, green and blue: xyz the slope, w the mean over all normals.
struct Coefficients {
  std::array<glm::vec4, 3> channels{glm::vec4(0.0F), glm::vec4(0.0F), glm::vec4(0.0F)};

  glm::vec3 at(const glm::vec3& normal) const {
    const glm::vec4 basis(normal, 1.0F);
    return {glm::dot(channels[0], basis), glm::dot(channels[1], basis), glm::dot(channels[2], basis)};
  }

  /// Adds the projection of `light` that is found at one of many normals which are spread evenly; its share of them is
  /// in it.
  void add(const glm::vec3& light, const glm::vec3& normal) {
    const glm::vec4 basis(3.0F * normal, 1.0F);
    for (int channel = 0; channel < 3; ++channel) channels[static_cast<std::size_t>(channel)] += light[channel] * basis;
  }
};

inline Coefficients operator*(const Coefficients& coefficients, const glm::vec3& by) {
  return {{coefficients.channels[0] * by.r, coefficients.channels[1] * by.g, coefficients.channels[2] * by.b}};
}

/// One for each grain.
using Field = std::vector<Coefficients>;

/// What leaves grains and walls because of lights: without and with other grains on the way.
struct Lit {
  Field direct;
  Field crossed;
};

inline Coefficients operator+(const Coefficients& a, const Coefficients& b) {
  return {{a.channels[0] + b.channels[0], a.channels[1] + b.channels[1], a.channels[2] + b.channels[2]}};
}

inline Coefficients operator-(const Coefficients& a, const Coefficients& b) {
  return {{a.channels[0] - b.channels[0], a.channels[1] - b.channels[1], a.channels[2] - b.channels[2]}};
}

}  // namespace mesograin::heap

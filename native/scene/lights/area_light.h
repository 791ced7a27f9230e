// A flat light of one bright side: a square, a rectangle, a disc or an ellipse.
#pragma once

#include <glm/vec3.hpp>

namespace mesograin::scene {

struct AreaLight {
  glm::dvec3 position{0.0};  ///< its middle
  glm::dvec3 half_x{0.5, 0.0, 0.0};
  glm::dvec3 half_y{0.0, 0.5, 0.0};        ///< it shines along -cross(half_x, half_y)
  glm::dvec3 radiance{1.0};                ///< linear RGB, along its normal
  bool ellipse = false;                    ///< the ellipse with these half axes, else the parallelogram
  double spread = 3.14159265358979323846;  ///< full angle of the cone that it shines into, as through a grid of slats
  bool drawn = false;                      ///< it stands for a surface of the scene, which is seen where it is

  bool operator==(const AreaLight&) const = default;
};

/// Throws Error if the light has no area, the radiance is negative, the spread is out of range, or a number is not
/// finite.
void validate(const AreaLight& light);

}  // namespace mesograin::scene

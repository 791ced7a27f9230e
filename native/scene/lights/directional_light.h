// A sun: parallel light, or a disc of it seen under a small angle.
#pragma once

#include <glm/vec3.hpp>

namespace mesograin::scene {

struct DirectionalLight {
  glm::dvec3 direction_to_light{0.0, 0.0, 1.0};  ///< from the scene towards the light, world space
  glm::dvec3 irradiance{1.0};                    ///< linear RGB, on a plane that faces each point of the disc
  double angle = 0.0;                            ///< of the sun's disc, edge to edge, radians; 0 is parallel light
  bool flat = false;                             ///< a flat disc, brighter towards its rim, not even in the sky

  bool operator==(const DirectionalLight&) const = default;
};

/// Throws Error if the direction has no length, the irradiance is negative, or a number is not finite.
void validate(const DirectionalLight& light);

}  // namespace mesograin::scene

// A point light of which only a cone is seen.
#pragma once

#include <glm/vec3.hpp>

#include "scene/lights/point_light.h"

namespace mesograin::scene {

struct SpotLight {
  glm::dvec3 position{0.0};
  glm::dvec3 axis{0.0, 0.0, -1.0};    ///< the direction in which it shines, of any length
  glm::dvec3 radiant_intensity{1.0};  ///< linear RGB, W/sr, along the axis
  double radius = 0.0;                ///< scene units; 0 is a point
  LightShape shape = LightShape::disc;
  double angle = 1.0;  ///< of the cone, edge to edge, radians
  double blend = 0.0;  ///< how much of the cone is its soft edge, 0 to 1
  /// Weakens with the cosine from the axis, as Cycles had it before Blender 4.0.
  bool cosine = false;
  /// The cone's cross-section, for one that is not round: world directions whose lengths say how wide it is along them,
  /// beside an axis of length 1. Zero vectors stand for a round one.
  glm::dvec3 wide_x{0.0};
  glm::dvec3 wide_y{0.0};

  bool operator==(const SpotLight&) const = default;
};

/// Throws Error if the axis has no length, the angle or the blend is out of range, or a number is not finite.
void validate(const SpotLight& light);

}  // namespace mesograin::scene

// One light, told by itself: a lamp beside a body, so near that each place of it has the lamp elsewhere, or a sun.
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>

namespace mesograin::transport {

/// What a place has of a lamp: of one of its points.
struct LampRay {
  glm::dvec3 to_lamp;  ///< unit length
  double irradiance;   ///< on a plane that faces it, per the lamp's strength
  double reach;        ///< how far away that point is
};

struct Lamp {
  /// At a place from the middle of the stretched mesh's box, in scene units along its axes. `random` in [0, 1)^2
  /// chooses the point; nothing stands between. From several threads.
  std::function<LampRay(const glm::dvec3& place, const glm::dvec2& random)> at;

  std::string about;  ///< lines of text that tell it from all others

  bool far = false;  ///< a sun: of the place `at` makes nothing
};

}  // namespace mesograin::transport

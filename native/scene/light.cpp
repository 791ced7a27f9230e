// What a directional light must satisfy.
#include "scene/light.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "scene/error.h"

namespace mesograin::scene {

void validate(const DirectionalLight& light) {
  const double length = glm::length(light.direction_to_light);
  if (!(length > 0.0 && std::isfinite(length)))
    throw Error("A light's direction_to_light must be a finite vector with a length; got ({}, {}, {}).",
                light.direction_to_light.x, light.direction_to_light.y, light.direction_to_light.z);
  for (int channel = 0; channel < 3; ++channel)
    if (!(light.irradiance[channel] >= 0.0 && std::isfinite(light.irradiance[channel])))
      throw Error("A light's irradiance must be finite and not negative; got ({}, {}, {}).", light.irradiance.r,
                  light.irradiance.g, light.irradiance.b);
  constexpr double pi = 3.14159265358979323846;
  if (!(light.angle >= 0.0 && light.angle <= pi))
    throw Error("A light's angle must lie between 0 and pi radians; got {}.", light.angle);
}

}  // namespace mesograin::scene

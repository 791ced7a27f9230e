// Checks of a light's numbers.
#include "scene/lights/requirements.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "base/error.h"

namespace mesograin::scene {

void require_direction(const glm::dvec3& direction, std::string_view name) {
  const double length = glm::length(direction);
  if (!(length > 0.0 && std::isfinite(length)))
    throw Error("A light's {} must be a finite vector with a length; got ({}, {}, {}).", name, direction.x, direction.y,
                direction.z);
}

void require_emission(const glm::dvec3& emission, std::string_view name) {
  for (int channel = 0; channel < 3; ++channel)
    if (!(emission[channel] >= 0.0 && std::isfinite(emission[channel])))
      throw Error("A light's {} must be finite and not negative; got ({}, {}, {}).", name, emission.r, emission.g,
                  emission.b);
}

void require_place(const glm::dvec3& place, std::string_view name) {
  if (!std::isfinite(glm::length(place)))
    throw Error("A light's {} must be finite; got ({}, {}, {}).", name, place.x, place.y, place.z);
}

void require_angle(double angle, std::string_view name) {
  constexpr double pi = 3.14159265358979323846;
  if (!(angle >= 0.0 && angle <= pi))
    throw Error("A light's {} must lie between 0 and pi radians; got {}.", name, angle);
}

void require_size(double size, std::string_view name) {
  if (!(size >= 0.0 && std::isfinite(size)))
    throw Error("A light's {} must be finite and not negative; got {}.", name, size);
}

}  // namespace mesograin::scene

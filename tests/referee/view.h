// What pictures of every body share: the camera's rays, and directions to a sun with extent.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "directions.h"
#include "scene/light.h"

namespace mesograin::referee {

struct Ray {
  glm::dvec3 origin, direction;
};

/// Through the point x, y of the image, from -1 to 1, to the right and upwards.
inline Ray view_ray(const glm::dmat4& clip_to_world, double x, double y) {
  const glm::dvec4 near = clip_to_world * glm::dvec4(x, y, -1, 1), far = clip_to_world * glm::dvec4(x, y, 1, 1);
  const glm::dvec3 origin = glm::dvec3(near) / near.w;
  return {origin, glm::normalize(glm::dvec3(far) / far.w - origin)};
}

inline glm::dvec3 sample_sun(const scene::DirectionalLight& sun, Rng& rng) {
  const glm::dvec3 centre = glm::normalize(sun.direction_to_light);
  if (sun.angle <= 0) return centre;
  return sample_cone(centre, 1 - rng.uniform() * (1 - std::cos(sun.angle / 2)), rng);
}

}  // namespace mesograin::referee

// One grain that fills a tiny picture, anywhere and of any size: what tests of the translucent models look at.
#pragma once

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <vector>

#include "render/view.h"
#include "scene/sphere.h"

namespace mesograin::render {

inline scene::MeshPointer sphere() {
  static const scene::MeshPointer mesh = std::make_shared<const scene::Mesh>(scene::unit_sphere(24, 12));
  return mesh;
}

/// From `direction`, filling the picture with the sphere that the transform makes of the unit sphere.
inline scene::Camera camera_at(const glm::dmat4& object_to_world, const glm::dvec3& direction) {
  const glm::dvec3 centre(object_to_world[3]);
  const double radius = object_to_world[0][0];
  const glm::dvec3 up = std::abs(direction.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  return {glm::lookAt(centre + 4.0 * radius * direction, centre, up),
          glm::ortho(-radius, radius, -radius, radius, radius, 7.0 * radius)};
}

inline std::vector<float> draw(View& view, int samples = 1) {
  view.render(samples);
  std::vector<float> pixels(static_cast<std::size_t>(view.width()) * static_cast<std::size_t>(view.height()) * 4);
  view.read(pixels.data());
  return pixels;
}

}  // namespace mesograin::render

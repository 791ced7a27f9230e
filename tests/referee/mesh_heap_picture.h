// What a camera sees of a scene of many meshes, all of its light: paths from the camera that find lights by leaving
// towards them.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/mat4x4.hpp>

#include "picture.h"
#include "scene/scene.h"

namespace mesograin::referee {

struct MeshHeapCase {
  scene::Scene scene;
  glm::dmat4 clip_to_world{1};  ///< OpenGL clip space
  int width = 0, height = 0;
  bool scattered = false;  ///< without what surfaces alone reflect and refract, of lights and of the world
  int samples = 256;       ///< paths a pixel, over its whole area
  std::uint64_t seed = 1;
  unsigned threads = 0;  ///< 0: as many as the machine has; the picture does not depend on it
};

/// Radiance of all that is not seen directly: light that was reflected, refracted or scattered at least once; what
/// shows nothing but the world is not covered. Suns up to 17 degrees across are stored (UnscatteredLight) where all
/// media scatter evenly (g 0); others need an extent, and as many more paths. What is no medium must be Lambertian, and
/// bodies stand apart, or touch. The world may be a colour or a picture.
/// `row_done`, if any, is called from any thread, once a row. Throws Error for what can't be traced.
Picture trace_mesh_heap(const MeshHeapCase& setup, const std::function<void()>& row_done = {});

}  // namespace mesograin::referee

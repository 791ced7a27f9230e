// What a camera sees of a sphere or a mesh in sunlight: radiance by backward walks, light of at least one scattering.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "scene/light.h"
#include "scene/material.h"
#include "scene/mesh.h"

namespace mesograin::referee {

/// One sphere, or one mesh; lengths in scene units, coefficients per scene unit. Of the material its medium, eta and
/// boundary count.
struct PictureCase {
  glm::dvec3 centre{0};
  double radius = 1;
  scene::MeshPointer mesh;  ///< instead of the sphere
  glm::dmat4 mesh_to_world{1};
  scene::Material material;
  std::vector<scene::DirectionalLight> lights;
  glm::dmat4 clip_to_world{1};  ///< OpenGL clip space
  int width = 0, height = 0;
  int samples = 256;  ///< paths a pixel, over its whole area
  std::uint64_t seed = 1;
  unsigned threads = 0;  ///< 0: as many as the machine has; the picture does not depend on it
};

/// Pixels by rows, row 0 at the top. The sun's mirror image and the light that crosses the sphere unscattered are not
/// in it: a camera without extent meets neither (but light that has entered in a cosine lobe is diffuse, so all of it
/// is there).
struct Picture {
  std::vector<glm::dvec3> radiance;  ///< premultiplied by coverage
  std::vector<glm::dvec3> noise;     ///< standard error of radiance
  std::vector<double> coverage;
};

/// `row_done`, if any, is called from any thread, once a row.
/// Throws Error for what can't be traced: a rough interface, g = -1 or 1, a camera inside the sphere.
Picture trace_picture(const PictureCase& setup, const std::function<void()>& row_done = {});

}  // namespace mesograin::referee

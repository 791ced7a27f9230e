// What is drawn: instances of meshes with a material each, and the lights on them.
#pragma once

#include <glm/mat4x4.hpp>
#include <vector>

#include "scene/light.h"
#include "scene/material.h"
#include "scene/mesh.h"

namespace mesograin::scene {

struct Instance {
  MeshPointer mesh;
  Material material;
  glm::dmat4 object_to_world{1.0};
};

struct Scene {
  std::vector<Instance> instances;
  std::vector<DirectionalLight> lights;
};

/// Throws Error for the first material, light or transform that cannot be drawn.
void validate(const Scene& scene);

}  // namespace mesograin::scene

// Checks a whole scene before anything of it reaches the device.
#include "scene/scene.h"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>

#include "base/error.h"

namespace mesograin::scene {

namespace {

void require_mesh(const MeshPointer& mesh) {
  if (!mesh) throw Error("Every instance needs a mesh; one came without.");
}

void require_invertible(const glm::dmat4& object_to_world) {
  const double volume = glm::determinant(object_to_world);
  if (!std::isfinite(volume) || volume == 0.0)
    throw Error("An instance's transform must be finite and invertible; its determinant is {}.", volume);
}

}  // namespace

std::vector<Material> materials_of(const Scene& scene) {
  std::vector<Material> materials;
  const auto add = [&](const Material& material) {
    if (std::find(materials.begin(), materials.end(), material) == materials.end()) materials.push_back(material);
  };
  for (const Instance& instance : scene.instances) add(instance.material);
  for (const InstanceArray& array : scene.arrays) add(array.material);
  return materials;
}

void validate(const Scene& scene) {
  for (const Instance& instance : scene.instances) {
    require_mesh(instance.mesh);
    validate(instance.material);
    require_invertible(instance.object_to_world);
  }
  for (const InstanceArray& array : scene.arrays) {
    require_mesh(array.mesh);
    validate(array.material);
    for (const glm::dmat4 object_to_world : array.object_to_world()) require_invertible(object_to_world);
    validate(array.factors(), array.object_to_world().size());
  }
  for (const Light& light : scene.lights) validate(light);
  validate(scene.world);
}

}  // namespace mesograin::scene

// Checks a whole scene before anything of it reaches the device.
#include "scene/scene.h"

#include <cmath>
#include <glm/matrix.hpp>

#include "scene/error.h"

namespace mesograin::scene {

void validate(const Scene& scene) {
  for (const Instance& instance : scene.instances) {
    if (!instance.mesh) throw Error("Every instance needs a mesh; one came without.");
    validate(instance.material);
    const double volume = glm::determinant(instance.object_to_world);
    if (!std::isfinite(volume) || volume == 0.0)
      throw Error("An instance's transform must be finite and invertible; its determinant is {}.", volume);
  }
  for (const DirectionalLight& light : scene.lights) validate(light);
}

}  // namespace mesograin::scene

// One number a channel.
#include "models/inputs_of_models.h"

namespace mesograin::models {

MaterialInputs lambert_inputs(const scene::Material& material, double /*grain_radius*/) {
  MaterialInputs inputs;
  inputs.uniforms["material.reflectance"] = glm::vec3(material.reflectance);
  return inputs;
}

}  // namespace mesograin::models

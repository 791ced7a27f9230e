// The facets' reflectance and how rough they lie.
#include "models/inputs_of_models.h"

namespace mesograin::models {

MaterialInputs conductor_inputs(const scene::Material& material, double /*grain_radius*/) {
  MaterialInputs inputs;
  inputs.facets = true;
  inputs.defines = {"FACETS_ALONE"};
  if (material.masking == scene::Masking::separable) inputs.defines.emplace_back("MASKING_SEPARABLE");
  inputs.uniforms["material.reflectance"] = glm::vec3(material.reflectance);
  inputs.uniforms["material.roughness"] = static_cast<float>(material.roughness);
  return inputs;
}

}  // namespace mesograin::models

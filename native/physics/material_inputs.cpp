// Chooses what each model's shader needs and rounds it to single precision only here, at the end.
#include "physics/material_inputs.h"

#include "physics/model_1_inputs.h"
#include "physics/model_2_inputs.h"
#include "physics/model_3_inputs.h"
#include "scene/error.h"

namespace mesograin::physics {
namespace {

using scene::Material;

MaterialInputs lambert_inputs(const Material& material) {
  MaterialInputs inputs;
  inputs.uniforms["material.reflectance"] = glm::vec3(material.reflectance);
  return inputs;
}

MaterialInputs conductor_inputs(const Material& material) {
  MaterialInputs inputs;
  if (material.masking == scene::Masking::separable) inputs.defines = {"MASKING_SEPARABLE"};
  inputs.uniforms["material.reflectance"] = glm::vec3(material.reflectance);
  inputs.uniforms["material.roughness"] = static_cast<float>(material.roughness);
  return inputs;
}

}  // namespace

bool depends_on_grain_radius(scene::Model model) {
  return model == scene::Model::model_2 || model == scene::Model::model_3;
}

MaterialInputs material_inputs(const Material& material, double grain_radius) {
  scene::validate(material);
  switch (material.model) {
    case scene::Model::lambert:
      return lambert_inputs(material);
    case scene::Model::conductor:
      return conductor_inputs(material);
    case scene::Model::model_1:
      return model_1_inputs(material);
    case scene::Model::model_2:
      return model_2_inputs(material, grain_radius);
    case scene::Model::model_3:
      return model_3_inputs(material, grain_radius);
  }
  throw Error("model must be one of the five that scene::Model names; got number {}.",
              static_cast<int>(material.model));
}

}  // namespace mesograin::physics

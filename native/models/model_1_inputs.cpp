// Model 1 is the half-space itself, whatever the grain's size.
#include "models/half_space_inputs.h"
#include "models/inputs_of_models.h"

namespace mesograin::models {

MaterialInputs model_1_inputs(const scene::Material& material, double /*grain_radius*/) {
  return half_space_inputs(material);
}

}  // namespace mesograin::models

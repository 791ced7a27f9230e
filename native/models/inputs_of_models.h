// One function a model: what its shader looks up. Each stands in <model>_inputs.cpp.
#pragma once

#include "models/material_inputs.h"

namespace mesograin::models {

/// The material is valid and of that model; `grain_radius` as in material_inputs.
#define MESOGRAIN_DECLARE_INPUTS(model) \
  MaterialInputs model##_inputs(const scene::Material& material, double grain_radius);
MESOGRAIN_FOR_EACH_MODEL(MESOGRAIN_DECLARE_INPUTS)
#undef MESOGRAIN_DECLARE_INPUTS

}  // namespace mesograin::models

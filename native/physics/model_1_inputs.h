// What model 1's shader looks up: which parts it is made of, their constants and tables.
#pragma once

#include "physics/material_inputs.h"

namespace mesograin::physics {

/// Throws Error for a profile that has no closed form or table here.
MaterialInputs model_1_inputs(const scene::Material& material);

}  // namespace mesograin::physics

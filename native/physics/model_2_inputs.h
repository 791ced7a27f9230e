// What model 2's shader looks up: model 1's half-space, and how a body of the grain's size differs from it.
#pragma once

#include "physics/material_inputs.h"

namespace mesograin::physics {

/// Throws Error for what model_1_inputs refuses.
MaterialInputs model_2_inputs(const scene::Material& material, double grain_radius);

}  // namespace mesograin::physics

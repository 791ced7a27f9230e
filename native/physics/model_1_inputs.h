// What model 1's shader looks up: which parts it is made of, their constants and tables.
#pragma once

#include "physics/material_inputs.h"

namespace mesograin::physics {

/// Throws Error for a profile that has no closed form or table here. Without `first_order`, light that scatters once is
/// left out, unless it enters by a cosine lobe.
MaterialInputs model_1_inputs(const scene::Material& material, bool first_order = true);

}  // namespace mesograin::physics

// What model 3's shader looks up: the kernel it integrates, how to sample it, and the refracted light that single
// scattering starts from.
#pragma once

#include "physics/material_inputs.h"

namespace mesograin::physics {

MaterialInputs model_3_inputs(const scene::Material& material, double grain_radius);

}  // namespace mesograin::physics

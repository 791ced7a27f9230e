// What shaders/models/dielectric.glsl needs.
#pragma once

#include "physics/material_inputs.h"

namespace mesograin::physics {

/// Adds the material's surface, if it is a dielectric one, to what its model needs.
void add_dielectric(const scene::Material& material, MaterialInputs& inputs);

}  // namespace mesograin::physics

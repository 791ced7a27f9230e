// What shaders/models/dielectric.glsl needs.
#pragma once

#include "models/material_inputs.h"

namespace mesograin::models {

/// Adds the material's surface, if it is a dielectric one, to what its model needs.
void add_dielectric(const scene::Material& material, MaterialInputs& inputs);

}  // namespace mesograin::models

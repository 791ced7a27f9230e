// What shaders/models/half_space_light.glsl looks up: which parts the half-space's light is made of, their constants
// and tables.
#pragma once

#include "models/material_inputs.h"

namespace mesograin::models {

/// The profile is one with a closed form or a table: not photon_beam. Without `first_order`, light that scatters once
/// is left out, unless it enters by a cosine lobe. Made once for grains of all sizes: those of the materials that came
/// last are held.
MaterialInputs half_space_inputs(const scene::Material& material, bool first_order = true);

}  // namespace mesograin::models

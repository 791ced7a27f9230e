// What shaders/models/dielectric.glsl needs.
#pragma once

#include "models/material_inputs.h"

namespace mesograin::models {

/// Whether the material's surface is of facets that mirror, and they are seen: MaterialInputs::facets.
bool shows_reflections(const scene::Material& material);

/// Adds what the material's surface reflects, if it is a dielectric one.
void add_reflection(const scene::Material& material, MaterialInputs& inputs);

/// Adds the material's surface, if it is a dielectric one, to what its model needs.
void add_dielectric(const scene::Material& material, MaterialInputs& inputs);

}  // namespace mesograin::models

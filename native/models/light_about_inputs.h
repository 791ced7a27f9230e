// What shaders/models/light_about.glsl walks in where a lamp is near.
#pragma once

#include "models/material_inputs.h"
#include "scene/material.h"

namespace mesograin::models {

/// The ball that stands for the grain; `radius` in scene units.
void add_light_about(const scene::Material& material, double radius, MaterialInputs& inputs);

}  // namespace mesograin::models

// What the shader of a finish (shaders/models/finish.glsl) looks up.
#pragma once

#include "models/material_inputs.h"

namespace mesograin::models {

/// The shader that draws an opaque model whose material has a finish. Stands for the model's own.
inline constexpr std::string_view finish_shader = "finish";

/// Makes the inputs of `material`, which has one, those of finish_shader.
void add_finish(const scene::Material& material, MaterialInputs& inputs);

}  // namespace mesograin::models

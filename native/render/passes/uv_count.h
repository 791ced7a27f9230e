// Counts how an unwrapping uses its texture.
#pragma once

#include "render/bake.h"
#include "render/passes/sample.h"

namespace mesograin::render {

/// Draws into the sample's texture.
UvUse count_uv_use(const Sample& sample);

}  // namespace mesograin::render

// What buffers on the device hold, and where they are bound: the text of shaders/render as C++. Its structs are of vec4
// and mat4 alone, which lie in std430 as they do here.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

namespace mesograin::render::layout {

using glm::mat4;
using glm::vec4;

#include "render/bindings.glsl"
#include "render/distant_light.glsl"
#include "render/shadow_view.glsl"
#include "render/stored_light_frame.glsl"
#include "render/tree_node.glsl"

}  // namespace mesograin::render::layout

// shadow.vert for many instances at once.

#include "render/bindings.glsl"
#include "scene/instances.glsl"

layout(location = 0) in vec3 position;

// Which instances are drawn; see render::Selection.
layout(std430, binding = SELECTED_BINDING) readonly buffer Selected { uint selected[]; };

uniform int first_selected;
uniform vec3 middle;  // of the mesh's bounds
uniform mat4 anchor_to_clip;

out vec3 from_anchor;
flat out float mark;

void main() {
  int instance = int(selected[first_selected + gl_InstanceID]);
  Placement placement = placement_of(instance);
  from_anchor = placement.linear * (position - middle) + placement.place;
  mark = float(instance + 1);
  gl_Position = anchor_to_clip * vec4(from_anchor, 1.0);
}

// surface.vert for many instances at once.

#include "passes/curved_surface.glsl"
#include "render/bindings.glsl"
#include "scene/instances.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
#ifdef TEXTURED
layout(location = 2) in vec2 uv;
out vec2 grain_uv;
#endif

// Which instances are drawn; see render::Selection.
layout(std430, binding = SELECTED_BINDING) readonly buffer Selected { uint selected[]; };

uniform int first_selected;
uniform vec3 middle;  // of the mesh's bounds
uniform mat4 anchor_to_clip;
uniform vec2 jitter;  // in normalised device coordinates

out vec3 grain_position;
out vec3 grain_normal;
out float grain_plane_offset;
flat out float mark;

void main() {
  int instance = int(selected[first_selected + gl_InstanceID]);
  Placement placement = placement_of(instance);
  // The cofactors are the inverse transposed but for the determinant, whose sign a mirrored grain must not lose.
  mat3 cofactors = mat3(cross(placement.linear[1], placement.linear[2]), cross(placement.linear[2], placement.linear[0]),
                        cross(placement.linear[0], placement.linear[1]));
  float handedness = sign(dot(placement.linear[0], cofactors[0]));
  grain_position = placement.linear * (position - middle);
#ifdef TEXTURED
  grain_uv = uv;
#endif
  grain_normal = normalize(handedness * (cofactors * normal));
  grain_plane_offset = tangent_plane_offset(grain_position, grain_normal);
  mark = handedness * float(instance + 1);
  gl_Position = anchor_to_clip * vec4(grain_position + placement.place, 1.0);
  gl_Position.xy += jitter * gl_Position.w;
}

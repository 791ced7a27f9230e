// Brings a mesh to clip space, and to grain space for shading: the world's axes, the origin in the middle of the grain.
// Both matrices are composed in double precision, so a grain far from the world's origin loses nothing.

#include "passes/curved_surface.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
#ifdef TEXTURED
layout(location = 2) in vec2 uv;
out vec2 grain_uv;
#endif

uniform mat4 object_to_clip;
uniform mat4 object_to_grain;
uniform mat3 normal_to_grain;
uniform vec2 jitter;  // in normalised device coordinates
uniform int instance;

out vec3 grain_position;
out vec3 grain_normal;
out float grain_plane_offset;
flat out float mark;

void main() {
  grain_position = (object_to_grain * vec4(position, 1.0)).xyz;
#ifdef TEXTURED
  grain_uv = uv;
#endif
  grain_normal = normalize(normal_to_grain * normal);
  grain_plane_offset = tangent_plane_offset(grain_position, grain_normal);
  mark = float(instance + 1);
  gl_Position = object_to_clip * vec4(position, 1.0);
  gl_Position.xy += jitter * gl_Position.w;
}

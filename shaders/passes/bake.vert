// Unwraps a mesh: every vertex lies at its UV, u to the right and v up; shading happens in grain space as ever.

#include "passes/curved_surface.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;

uniform mat4 object_to_grain;
uniform mat3 normal_to_grain;
uniform vec2 jitter;  // in normalised device coordinates

out vec2 grain_uv;
out vec3 grain_position;
out vec3 grain_normal;
out float grain_plane_offset;

void main() {
  grain_position = (object_to_grain * vec4(position, 1.0)).xyz;
  grain_normal = normalize(normal_to_grain * normal);
  grain_plane_offset = tangent_plane_offset(grain_position, grain_normal);
  grain_uv = uv;
  gl_Position = vec4(2.0 * uv - 1.0 + jitter, 0.0, 1.0);
}

// A grain as one of its lights sees it, orthographically, in light space (shaders/models/light_map.glsl).

#include "passes/curved_surface.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;

uniform mat4 object_to_clip;
uniform mat4 object_to_light;
uniform mat3 normal_to_light;

out vec3 light_position;
out vec3 light_normal;
out float light_plane_offset;

void main() {
  light_position = (object_to_light * vec4(position, 1.0)).xyz;
  light_normal = normal_to_light * normal;
  light_plane_offset = tangent_plane_offset(light_position, light_normal);
  gl_Position = object_to_clip * vec4(position, 1.0);
}

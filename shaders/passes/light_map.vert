// A grain as one of its lights sees it, orthographically, in light space (shaders/models/light_map.glsl).

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;

uniform mat4 object_to_light;
uniform mat3 normal_to_light;
uniform mat4 light_to_clip;

out Corner {
  vec3 position;
  vec3 normal;
}
corner;

void main() {
  corner.position = (object_to_light * vec4(position, 1.0)).xyz;
  corner.normal = normalize(normal_to_light * normal);
  gl_Position = light_to_clip * vec4(corner.position, 1.0);
}

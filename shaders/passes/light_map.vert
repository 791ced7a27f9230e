// A grain as one of its lights sees it, orthographically, in light space (shaders/models/light_map.glsl).

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;

uniform mat4 object_to_clip;
uniform mat4 object_to_light;
uniform mat3 normal_to_light;

out float light_depth;
out vec3 light_normal;

void main() {
  light_depth = (object_to_light * vec4(position, 1.0)).z;
  light_normal = normal_to_light * normal;
  gl_Position = object_to_clip * vec4(position, 1.0);
}

// Brings a mesh to camera space, and to clip space with the sample's sub-pixel offset.

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;

uniform mat4 object_to_camera;
uniform mat3 normal_to_camera;
uniform mat4 camera_to_clip;
uniform vec2 jitter;  // in normalised device coordinates

out vec3 camera_position;
out vec3 camera_normal;

void main() {
  vec4 in_camera = object_to_camera * vec4(position, 1.0);
  camera_position = in_camera.xyz;
  camera_normal = normal_to_camera * normal;
  gl_Position = camera_to_clip * in_camera;
  gl_Position.xy += jitter * gl_Position.w;
}

// A mesh as a light sees it.

layout(location = 0) in vec3 position;

uniform mat4 object_to_anchor;
uniform mat4 anchor_to_clip;
uniform int instance;

out vec3 from_anchor;
flat out float mark;

void main() {
  vec4 place = object_to_anchor * vec4(position, 1.0);
  from_anchor = place.xyz;
  mark = float(instance + 1);
  gl_Position = anchor_to_clip * place;
}

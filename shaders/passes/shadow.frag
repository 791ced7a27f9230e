// One texel of a shadow map: how near to the light the surface is, and whose it is.

in vec3 from_anchor;
flat in float mark;

uniform vec4 eye;  // as in shadows.glsl

out vec2 nearest;

void main() { nearest = vec2(eye.w > 0.0 ? -distance(from_anchor, eye.xyz) : dot(from_anchor, eye.xyz), mark); }

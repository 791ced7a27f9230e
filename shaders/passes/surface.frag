// What the camera sees of a grain, before any light: each pixel is then shaded once. A triangle's edge would cost whole blocks of pixels,
// and what another triangle hides later would be shaded for nothing.

//
// What is chosen at compile time:
//   TEXTURED     there are surfaces that wear pictures

#include "passes/curved_surface.glsl"
#ifdef TEXTURED
#include "scene/tangent.glsl"

in vec2 grain_uv;
layout(location = 2) out vec4 surface_coordinates;  // xy: UV; zw: a packed tangent
#endif

in vec3 grain_position;
in vec3 grain_normal;
in float grain_plane_offset;
flat in float mark;  // number of the instance, from 1; negative if it is mirrored

layout(location = 0) out vec4 surface_position;
layout(location = 1) out vec4 surface_normal;

void main() {
  vec3 normal = normalize(grain_normal);
  float rise = dot(on_curved_surface(grain_position, grain_normal, grain_plane_offset) - grain_position, normal);
  surface_position = vec4(grain_position, rise);
  surface_normal = vec4(normal, gl_FrontFacing ? mark : -mark);
#ifdef TEXTURED
  vec2 tangent = packed_tangent(normal, dFdx(grain_position), dFdy(grain_position), dFdx(grain_uv), dFdy(grain_uv));
  surface_coordinates = vec4(grain_uv, tangent);
#endif
}

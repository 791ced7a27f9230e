// A texel of an unwrapped grain, seen from straight above or from the camera.

#include "passes/curved_surface.glsl"
#include "passes/lit_point.glsl"

#ifdef TEXTURED
in vec2 grain_uv;
#endif
in vec3 grain_position;
in vec3 grain_normal;
in float grain_plane_offset;

uniform int from_camera;
uniform int instance;

out vec4 radiance;

// A texture has texels that the camera does not see; they are lit as if it looked at them from low above. This is what
// Cycles' bake does, so that both sides mean the same: never below a rise of 0.2, and straight from above where the
// surface faces away.
vec3 bent_to_viewer(vec3 position, vec3 normal) {
  const float least_rise = 0.2;
  vec3 direction = direction_to_viewer(position);
  float cosine = dot(direction, normal);
  if (cosine > least_rise) return direction;
  direction = normalize(direction + (least_rise - cosine) * normal);
  return cosine > 0.0 ? direction : normalize(mix(direction, normal, -cosine));
}

void main() {
  take_grain(instance);
  SurfacePoint point;
  point.position = on_curved_surface(grain_position, grain_normal, grain_plane_offset);
  point.on_triangle = grain_position;
  point.normal = normalize(grain_normal);
  point.to_viewer = from_camera != 0 ? bent_to_viewer(point.position, point.normal) : point.normal;
#ifdef TEXTURED
  surface_uv = grain_uv;
  surface_in_mesh = to_mesh(grain_position);
  surface_tangent =
      unpacked_tangent(point.normal, packed_tangent(point.normal, dFdx(grain_position), dFdy(grain_position), dFdx(grain_uv), dFdy(grain_uv)));
  put_on(point);
#endif
  radiance = vec4(lit_point(point), 1.0);
}

// A pixel of the grain as the camera sees it: light on what surface.frag found there. Or as another surface mirrors it: light on what a ray met
// on its way from there.
//
// What else is chosen at compile time:
//   MIRRORED             it is seen in another surface

#include "passes/lit_point.glsl"

uniform sampler2D surface_position;  // xyz: on the triangle; w: how far the curved surface rises above it, along the normal
uniform sampler2D surface_normal;    // xyz: of unit length; w: number of the instance, from 1; negative on back faces
#ifdef TEXTURED
uniform sampler2D surface_coordinates;  // xy: UV; zw: a packed tangent
#endif

layout(location = 0) out vec4 radiance;
#ifdef LOOKS_ON
layout(location = 1) out vec4 mirrored_radiance;  // of the world, if nothing stands in the way; w: what alpha then lacks, negative
layout(location = 2) out vec4 mirrored_from;      // w: 1 where there is any
layout(location = 3) out vec4 mirrored_passed;    // what an object's radiance is multiplied by; w: 1 if the camera looks straight on
#endif

void main() {
  vec4 on_triangle = texelFetch(surface_position, ivec2(gl_FragCoord.xy), 0);
  vec4 facing = texelFetch(surface_normal, ivec2(gl_FragCoord.xy), 0);
  take_grain(int(abs(facing.w)) - 1);
  SurfacePoint point;
  point.position = (on_triangle.xyz + on_triangle.w * facing.xyz) / grain_unit;
  point.on_triangle = on_triangle.xyz / grain_unit;
  point.to_viewer = direction_to_viewer(on_triangle.xyz);
  point.normal = facing.xyz;

  // The side that is seen is the side that is lit, so that open meshes have two. On a closed grain's silhouette a back
  // face can win the depth test against the front face beside it; its normal is at grazing and must not be turned.
  const float grazing = -0.1;
  float cosine = dot(point.normal, point.to_viewer);
  if (facing.w < 0.0 && cosine < grazing) {
    point.normal = -point.normal;
    cosine = -cosine;
  }

  // Near a silhouette the interpolated normal can point away from the viewer although the surface does not.
  const float least_cosine = 1e-4;
  if (cosine < least_cosine) point.normal = normalize(point.normal + (least_cosine - cosine) * point.to_viewer);

#ifdef TEXTURED
  vec4 coordinates = texelFetch(surface_coordinates, ivec2(gl_FragCoord.xy), 0);
  surface_uv = coordinates.xy;
  surface_in_mesh = to_mesh(on_triangle.xyz);
  surface_tangent = unpacked_tangent(facing.xyz, coordinates.zw);
  put_on(point);
#endif

#ifdef MIRRORED
  vec4 passed = passed_on();
  radiance = vec4(lit_point(point) * passed.rgb, 0.0);
#else
  const vec4 passed = vec4(1.0);
  radiance = vec4(PORTION == NORMAL_PORTION ? point.normal : lit_point(point), 1.0);
#endif
#ifdef FILM_TRANSPARENT
  float alpha_lacks = dot(film_seen * passed.rgb, vec3(1.0 / 3.0));
#endif
#if defined(FILM_TRANSPARENT) && !defined(LOOKS_ON)
  radiance.a -= alpha_lacks;
#endif
#ifdef LOOKS_ON
  bool any_mirrored = max(mirrored.passed.r, max(mirrored.passed.g, mirrored.passed.b)) > 0.0;
  mirrored_radiance = vec4(mirrored.radiance * passed.rgb, 0.0);
#ifdef FILM_TRANSPARENT
  mirrored_radiance.a -= alpha_lacks;
#endif
#ifdef SEES_BEHIND
  float straight_on = passed.w;
#else
  const float straight_on = 0.0;
#endif
  mirrored_passed = vec4(mirrored.passed * passed.rgb, straight_on);
  mirrored_from = vec4(mirrored.from, any_mirrored ? 1.0 : 0.0);
#endif
}

// Model 1: a grain so thick that it answers like a half-space of its medium, which makes a BRDF of the BSSRDF. No light map.
// Not physical: no light passes through or around a grain, so its unlit side is black.
//
// What is chosen at compile time:
//   TOLD                 its surface alone: what is scattered in it is told (heap/light_from_grains.glsl)
#include "models/half_space_light.glsl"
#include "models/interface.glsl"
#include "models/portions.glsl"

Outwards look_outwards(SurfacePoint point) { return through_surface(point); }

vec3 evaluate_model(SurfacePoint point, Outwards outwards, LightSample light) {
#ifdef TOLD
  vec3 radiance = vec3(0.0);
#else
  HalfSpaceLight result = half_space_light(point, outwards, light);
  vec3 radiance = portion(SINGLE_SCATTERING_PORTION, result.single) + portion(SUBSURFACE_PORTION, result.multiple);
#endif
#ifdef SPECULAR
  radiance += portion(SPECULAR_PORTION, specular_reflection(point, outwards, light));
#endif
  return radiance;
}

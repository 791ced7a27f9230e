// Model 2: one look into the light map. Model 1's half-space, corrected by how a sphere of the same medium differs from it: the sphere
// whose chord along the light and whose normal are those of this point.
// Not physical: the rest of the grain's shape is not seen, and what the sphere has beyond the half-space leaves like diffused light.
//
// What is chosen at compile time (physics::model_2_inputs), besides what body_light.glsl names:
//   SEPARATE_SINGLE      `single_difference`: anisotropic first-order scattering has a table of its own
#include "models/body_light.glsl"
#include "models/half_space_light.glsl"
#include "models/interface.glsl"
#include "models/portions.glsl"

#ifdef SEPARATE_SINGLE
uniform sampler2D single_difference;
uniform float separate_single;  // how much of it is; the rest is as all that is scattered more often
#endif

Outwards look_outwards(SurfacePoint point) { return through_surface(point); }

vec3 evaluate_model(SurfacePoint point, Outwards outwards, LightSample light) {
  BodyFit fit = fit_body(point, outwards, light, light_frame(light));
  HalfSpaceLight half_space = half_space_light(point, outwards, light);
  vec4 difference = look_up_body(body_table, fit);
  vec3 lobe = light.entering * flowing_lobe(fit, point, light, flow_at(fit, difference));
#ifdef SEPARATE_SINGLE
  half_space.multiple += (1.0 - separate_single) * half_space.single;
#endif
  vec3 radiance = portion(SUBSURFACE_PORTION, corrected(fit.visible * half_space.multiple, difference.rgb, lobe));
#ifdef SEPARATE_SINGLE
  vec3 out_of = refract(-point.to_viewer, point.normal, sqrt(material.inverse_eta_squared));
  vec3 sum = out_of - material.sign_g * light.to_light;
  float versine = 0.5 * dot(sum, sum);
  float phase = 4.0 * PI * henyey_greenstein(versine, material.absolute_g, material.one_minus_absolute_g);
  vec3 single_lobe = phase * diffused_lobe(fit) * light.entering;
  vec3 single = corrected(fit.visible * half_space.single, look_up_body(single_difference, fit).rgb, single_lobe);
  radiance += portion(SINGLE_SCATTERING_PORTION, separate_single * single);
#endif
  radiance *= fit.entered;
#ifdef SPECULAR
  radiance += portion(SPECULAR_PORTION, fit.reached * fit.visible * specular_reflection(point, outwards, light));
#endif
  return radiance;
}

// The light that a half-space of the grain's medium sends back, as a BRDF.
//
// What is chosen at compile time (physics::material_inputs):
//   REFRACTION           a dielectric interface: Fresnel on both ways, refracted directions, 1/eta^2
//   MULTIPLE_TABLE       `multiple_scattering`: what the half-space solver left in a table over both directions; in alpha, if
//                        ROUGH_SURFACE, what the surface lets through, both passages in one
//   MULTIPLE_CONSTANT    `material.diffuse`: a constant radiance per irradiance
//   VIEW_TABLE           `multiple_scattering`: as MULTIPLE_TABLE, over the viewer's direction alone
//   SINGLE_SCATTERING    first-order scattering in closed form, where the table does not hold it already
#include "models/dielectric.glsl"
#include "models/interface.glsl"
#include "physics/prelude.glsl"
#include "physics/fresnel.glsl"
#include "physics/half_space.glsl"
#include "physics/henyey_greenstein.glsl"

struct Material {
  vec3 albedo;
  vec3 diffuse;
  float eta;
  float inverse_eta_squared;
  float absolute_g;
  float one_minus_absolute_g;
  float sign_g;
};
uniform Material material;

#if defined(MULTIPLE_TABLE) || defined(VIEW_TABLE)
uniform sampler2D multiple_scattering;

// A coordinate in [0, 1] that reaches the centres of the first and the last texel.
vec2 texel_coordinate(vec2 coordinate) {
  vec2 size = vec2(textureSize(multiple_scattering, 0));
  return (coordinate * (size - 1.0) + 0.5) / size;
}
#endif

// Radiance towards the viewer, cosine included; black where the light comes from behind.
struct HalfSpaceLight {
  vec3 single;    // first order, if SINGLE_SCATTERING
  vec3 multiple;  // everything else
};

HalfSpaceLight half_space_light(SurfacePoint point, Outwards outwards, LightSample light) {
  HalfSpaceLight result = HalfSpaceLight(vec3(0.0), vec3(0.0));
  // No branch: where the light comes from behind, the irradiance is 0.
  float mu_i = clamp(dot(point.normal, light.to_light), 0.0, 1.0);
  float mu_o = outwards.mu;
  vec3 irradiance = light.entering * mu_i;

#if defined(VIEW_TABLE)
  result.multiple = texture(multiple_scattering, texel_coordinate(vec2(sqrt(mu_o), 0.5))).rgb * irradiance;
#else
#ifdef REFRACTION
  float mu_i_refracted = refracted_cosine(mu_i, material.eta);
#else
  float mu_i_refracted = mu_i;
#endif
  float mu_o_refracted = outwards.mu_refracted;
#ifdef MULTIPLE_TABLE
  vec2 coordinate = vec2(half_space_coordinate(mu_i, mu_i_refracted), half_space_coordinate(mu_o, mu_o_refracted));
  vec4 scattered = texture(multiple_scattering, texel_coordinate(coordinate));
#endif

#if defined(MULTIPLE_TABLE) && defined(ROUGH_SURFACE)
  float transmittance = scattered.a;
#elif defined(REFRACTION)
  float transmittance = surface_transmittance(mu_i, mu_i_refracted) * outwards.transmittance;
#else
  float transmittance = 1.0;
#endif

#ifdef MULTIPLE_CONSTANT
  result.multiple += transmittance * material.diffuse * irradiance;
#endif
#if defined(MULTIPLE_TABLE) || defined(SINGLE_SCATTERING)
  float factor = half_space_factor(mu_i_refracted, mu_o_refracted, transmittance, material.inverse_eta_squared);
#ifdef MULTIPLE_TABLE
  result.multiple += factor * scattered.rgb * irradiance;
#endif
#ifdef SINGLE_SCATTERING
  float versine = refracted_versine(light.to_light, mu_i, mu_i_refracted, point.to_viewer, mu_o, mu_o_refracted, point.normal,
                                    material.inverse_eta_squared, material.sign_g);
  result.single = factor * material.albedo * henyey_greenstein(versine, material.absolute_g, material.one_minus_absolute_g) * irradiance;
#endif
#endif
#endif
  return result;
}

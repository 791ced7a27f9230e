// A rough conductor whose Fresnel reflectance is a constant colour: one bounce off GGX microfacets.
// Not physical: light that meets a second microfacet is lost (up to 69 % for white at roughness 1). Roughness 0 is drawn as
// GGX_SMALLEST_ALPHA, the narrowest highlight that single precision resolves.
#include "models/interface.glsl"
#include "models/mirrored_world.glsl"
#include "models/portions.glsl"
#include "physics/prelude.glsl"
#include "physics/ggx.glsl"

struct Material {
  vec3 reflectance;
  float roughness;
};
uniform Material material;

Outwards look_outwards(SurfacePoint point) {
  float mu = clamp(dot(point.normal, point.to_viewer), 0.0, 1.0);
  return Outwards(mu, mu, 0.0);
}

#ifdef MIRRORS_WORLD
float facet_alpha() { return max(material.roughness, GGX_SMALLEST_ALPHA); }
vec3 facet_reflectance(float mu_h) { return material.reflectance; }
#endif

vec3 evaluate_model(SurfacePoint point, Outwards outwards, LightSample light) {
  float mu_i = dot(point.normal, light.to_light);
  if (mu_i <= 0.0) return vec3(0.0);
  float mu_o = outwards.mu;
  vec3 sum = light.to_light + point.to_viewer;
  vec3 half_vector = sum * inversesqrt(max(dot(sum, sum), 1e-12));
  float alpha = max(material.roughness, GGX_SMALLEST_ALPHA);
#ifdef MASKING_SEPARABLE
  float visibility = ggx_visibility_separable(mu_i, mu_o, alpha);
#else
  float visibility = ggx_visibility_correlated(mu_i, mu_o, alpha);
#endif
#ifdef MIRRORS_WORLD
  light.irradiance *= share_of_light(point, light, mu_o);
#endif
  vec3 reflected = material.reflectance * light.irradiance * (ggx_distribution(point.normal, half_vector, alpha) * visibility * mu_i);
  return portion(SPECULAR_PORTION, reflected);
}

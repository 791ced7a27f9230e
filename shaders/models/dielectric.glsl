// A grain's dielectric surface: what it reflects, and what it lets in and out. What enters is what was not reflected.
// Not physical: light that meets a second facet counts as not reflected, so it enters; what has entered goes on as below a
// smooth surface, but in the model `transport`. A smooth surface is a mirror, in which a light without extent shows nothing.
//
// What is chosen at compile time (physics::add_dielectric):
//   REFRACTION           light is refracted and, if the surface is smooth, follows Fresnel
//   ROUGH_SURFACE        `passage`: what a rough surface lets through
//   SPECULAR             what the surface reflects is seen
//   MASKING_SEPARABLE    masking and shadowing of facets are independent
#include "models/interface.glsl"
#include "models/mirrored_world.glsl"
#include "physics/prelude.glsl"
#include "physics/dielectric.glsl"
#include "physics/half_space.glsl"

struct Surface {
  float eta;
  float roughness;
};
uniform Surface surface;

#ifdef ROUGH_SURFACE
uniform sampler2D passage;
#endif

// What light at this cosine outside is multiplied by as it passes the surface, one way or the other.
float surface_transmittance(float mu, float mu_refracted) {
#ifdef ROUGH_SURFACE
  float last = float(textureSize(passage, 0).x - 1);
  return texture(passage, vec2((half_space_coordinate(mu, mu_refracted) * last + 0.5) / (last + 1.0), 0.5)).x;
#else
  return fresnel_transmittance(mu, mu_refracted, surface.eta);
#endif
}

Outwards through_surface(SurfacePoint point) {
  float mu = clamp(dot(point.normal, point.to_viewer), 0.0, 1.0);
#ifdef REFRACTION
  float mu_refracted = refracted_cosine(mu, surface.eta);
  return Outwards(mu, mu_refracted, surface_transmittance(mu, mu_refracted));
#else
  return Outwards(mu, mu, 1.0);
#endif
}

#ifdef MIRRORS_WORLD
float facet_alpha() { return max(surface.roughness, GGX_SMALLEST_ALPHA); }
vec3 facet_reflectance(float mu_h) { return vec3(fresnel_reflectance(mu_h, surface.eta)); }
#endif

#ifdef SPECULAR
// Radiance to the viewer that the surface reflects.
vec3 specular_reflection(SurfacePoint point, Outwards outwards, LightSample light) {
  light.to_light = light.itself;
  float mu_i = dot(point.normal, light.to_light);
#ifdef MIRRORS_WORLD
  // Facets look for the world themselves: there is no lobe of few directions to be joined.
  float alpha = light.density > 0.0 ? facet_alpha() : dielectric_alpha(surface.roughness, light.angle);
  light.irradiance *= share_of_light(point, light, outwards.mu);
#else
  float alpha = dielectric_alpha(surface.roughness, light.angle);
#endif
  if (mu_i <= 0.0 || alpha <= 0.0) return vec3(0.0);
#ifdef MASKING_SEPARABLE
  const bool correlated = false;
#else
  const bool correlated = true;
#endif
  return light.irradiance * (mu_i * dielectric_reflection(point.normal, light.to_light, mu_i, point.to_viewer, outwards.mu, surface.eta,
                                                          max(alpha, GGX_SMALLEST_ALPHA), correlated));
}
#endif

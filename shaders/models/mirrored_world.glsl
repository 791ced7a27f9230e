// What a surface of facets mirrors. Of the world: directions that are drawn for all pixels together and one that each pixel draws for itself,
// weighted by how likely each was to be drawn (Veach and Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering", 1995,
// the balance heuristic). The former find what is bright, the latter what a smooth surface shows. Of other objects: the latter alone.
//
// What is chosen at compile time:
//   MIRRORS_WORLD        the surface has facets, and there is a world, or something that may stand before it
//   MIRRORS_HINDERED     something may: a ray follows
#include "models/interface.glsl"
#include "models/pixel_random.glsl"
#include "physics/prelude.glsl"
#include "physics/ggx.glsl"
#include "scene/world.glsl"

struct Mirrored {
  vec3 radiance;  // of the world, if nothing stands in the way
  vec3 passed;    // what the radiance of an object that does is multiplied by
  vec3 from;      // unit length
};

#ifdef MIRRORS_WORLD
// Of the facets at the point that was looked at last; models define both.
float facet_alpha();
vec3 facet_reflectance(float mu_h);  // mu_h: between the light and the facet's normal

// How much of what facets send of a light is told by the directions drawn for all pixels.
float share_of_light(SurfacePoint point, LightSample light, float mu_o) {
  if (light.density <= 0.0) return 1.0;
  vec3 sum = light.to_light + point.to_viewer;
  float alpha = facet_alpha();
  float own = ggx_mirrored_density(ggx_distribution(point.normal, sum * inversesqrt(max(dot(sum, sum), 1e-12)), alpha), mu_o, alpha);
  return light.density / (light.density + own);
}

#ifdef MIRRORS_HINDERED
// What a surface mirrors this much of, a ray always follows; what it mirrors less of, as often as it is less, to count as much more (Arvo and
// Kirk, "Particle Transport and Image Synthesis", 1990, Russian roulette).
const float MIRRORED_FOR_SURE = 0.1;
const float FOLLOWED_AT_LEAST = 0.0625;

// What a ray counts, 0 if none follows. Neighbours are of one mind: those that go together as rays (native/render/cast_mirrors.cpp) and, on
// software renderers, as fragments.
float follow(vec3 passed) {
  float likely = clamp(max(passed.r, max(passed.g, passed.b)) / MIRRORED_FOR_SURE, FOLLOWED_AT_LEAST, 1.0);
  uvec4 offset = pcg4d(uvec4(uvec2(gl_FragCoord.xy) / uvec2(4u, 2u), 5u, 0u));
  // The golden ratio's sequence, beside those of the dimensions that pixels draw from.
  float random = float((2654435769u * uint(sample_index) + offset.x) >> 8u) * (1.0 / 16777216.0);
  return random < likely ? 1.0 / likely : 0.0;
}
#endif

Mirrored mirrored_world(SurfacePoint point, float mu_o) {
  float alpha = facet_alpha();
  vec2 random = low_discrepancy_beside_pixel(uint(sample_index), pcg4d(uvec4(uvec2(gl_FragCoord.xy), 4u, 0u)).xy);
  vec3 facet = ggx_visible_facet(point.normal, point.to_viewer, alpha, random);
  float mu_h = clamp(dot(facet, point.to_viewer), 0.0, 1.0);
  Mirrored mirrored = Mirrored(vec3(0.0), vec3(0.0), normalize(2.0 * mu_h * facet - point.to_viewer));
  float mu_i = dot(point.normal, mirrored.from);
  if (mu_i <= 0.0) return mirrored;
#ifdef MASKING_SEPARABLE
  float visibility = ggx_visibility_separable(mu_i, mu_o, alpha);
#else
  float visibility = ggx_visibility_correlated(mu_i, mu_o, alpha);
#endif
  float own = ggx_mirrored_density(ggx_distribution(point.normal, facet, alpha), mu_o, alpha);
  // BRDF times cosine over density: the distribution cancels.
  float passed = 2.0 * visibility * mu_i * (mu_o + ggx_smith_root(mu_o, alpha));
  float share = own / (own + drawn_density_of_world(mirrored.from));
  mirrored.passed = passed * facet_reflectance(mu_h);
#ifdef MIRRORS_HINDERED
  mirrored.passed *= follow(mirrored.passed);
#endif
  mirrored.radiance = share * mirrored.passed * seen_of_world(mirrored.from);
  return mirrored;
}
#endif

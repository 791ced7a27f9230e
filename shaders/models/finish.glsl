// An opaque surface that is no grain: Lambertian or Burley's diffuse under a dielectric coat, a rough conductor, what lies between them; worn
// pictures; light of its own.
//
// What is chosen at compile time:
//   REFLECTANCE_MAP, ROUGHNESS_MAP, METALLIC_MAP, NORMAL_MAP, EMISSION_MAP   a picture says it
//   METALLIC            some of it is a conductor
//   COAT                the rest has a coat
//   COAT_SHADES_BASE    and lets through what it does not reflect
//   METAL_WHITENS       the conductor's reflectance rises to 1 at grazing, and a coat is a layer of its own
//   FACETS_KEEP_ENERGY  what one bounce off the facets loses is sent on in their lobe
//   FACET_ENERGY        there is a table of what one bounce sends
//   FACETS_SHADE_BUMPS  what a bent normal shades of itself is masked as facets are
//   RETRO_REFLECTIVE    the diffuse share is Burley's
//   ROUGH_DIFFUSE       or Oren's and Nayar's
//   EMITS               it sends out light
#include "models/interface.glsl"
#include "models/mirrored_world.glsl"
#include "models/portions.glsl"
#include "physics/prelude.glsl"
#include "physics/ggx.glsl"
#include "physics/fresnel.glsl"
#include "scene/texturing.glsl"

struct Material {
  vec3 reflectance;
  float roughness;  // the square root of alpha
  float metallicity;
  float diffuse_roughness;
  float coat;       // reflectance seen straight on
  float coat_mean;  // reflectance of light from everywhere
  float normal_strength;
  vec3 radiance;
};
uniform Material material;

#ifdef TEXTURED
struct TextureMap {
  vec4 across;
  vec4 up;
  int by_position;
  int srgb;
};

vec3 linear_of_srgb(vec3 encoded) {
  vec3 dark = encoded / 12.92;
  vec3 bright = pow((max(encoded, vec3(0.0)) + 0.055) / 1.055, vec3(2.4));
  return mix(bright, dark, lessThan(encoded, vec3(0.04045)));
}

vec3 looked_up(sampler2D picture, TextureMap map) {
  vec4 place = map.by_position != 0 ? vec4(surface_in_mesh, 1.0) : vec4(surface_uv, 0.0, 1.0);
  vec2 at = vec2(dot(map.across, place), dot(map.up, place));
  vec3 texel = textureLod(picture, at, 0.0).rgb;
  return map.srgb != 0 ? linear_of_srgb(texel) : texel;
}

float mean_of(vec3 colour) { return clamp((colour.r + colour.g + colour.b) / 3.0, 0.0, 1.0); }
#endif

#ifdef REFLECTANCE_MAP
uniform TextureMap reflectance_map;
uniform sampler2D reflectance_picture;
#endif
#ifdef ROUGHNESS_MAP
uniform TextureMap roughness_map;
uniform sampler2D roughness_picture;
#endif
#ifdef METALLIC_MAP
uniform TextureMap metallic_map;
uniform sampler2D metallic_picture;
#endif
#ifdef NORMAL_MAP
uniform TextureMap normal_map;
uniform sampler2D normal_picture;
#endif
#ifdef EMISSION_MAP
uniform TextureMap emission_map;
uniform sampler2D emission_picture;
#endif

#ifdef FACET_ENERGY
// Rows by roughness, columns by the root of the viewer's cosine. What facets send of light from everywhere after one bounce: such that absorb
// nothing, the coat's, the former's mean over viewers.
uniform sampler2D facet_energy;
#endif

// Of the point that is shaded, once for all lights.
vec3 point_reflectance;
float point_alpha;
float point_metallicity;

vec3 metal_kept, coat_kept;  // what facets send on beside what one bounce does
float base_seen;             // through the coat

#ifdef NORMAL_MAP
vec3 unbent_normal;
vec3 bent_normal;

// The normal nearest to the bent one whose mirror direction leaves the surface, as Cycles has it: the viewer of a steep map sees no black.
vec3 with_valid_reflection(vec3 straight, vec3 to_viewer, vec3 bent) {
  float across = dot(straight, to_viewer);
  float threshold = min(0.9 * across, 0.01);
  if (dot(straight, 2.0 * dot(bent, to_viewer) * bent - to_viewer) >= threshold) return bent;
  vec3 x = normalize(bent - dot(bent, straight) * straight);
  float viewer_x = dot(to_viewer, x);
  float a = viewer_x * viewer_x + across * across;
  float b = sqrt(max(viewer_x * viewer_x * (a - threshold * threshold), 0.0));
  float c = across * threshold + a;
  vec2 z2 = 0.5 / a * vec2(c + b, c - b);
  vec2 z = sqrt(max(z2, 0.0));
  vec2 sine = sqrt(max(1.0 - z2, 0.0));
  vec2 rise = 2.0 * (sine * viewer_x + z * across) * z - across;
  bvec2 valid = bvec2(z2.x > 1e-5 && z2.x <= 1.0 + 1e-5, z2.y > 1e-5 && z2.y <= 1.0 + 1e-5);
  if (!any(valid)) return straight;
  bool first = valid.x;
  if (all(valid)) first = min(rise.x, rise.y) >= 1e-5 ? rise.x < rise.y : rise.x > rise.y;
  return first ? sine.x * x + z.x * straight : sine.y * x + z.y * straight;
}

// What a bump that a normal tells of shades of itself (Estevez et al., "A Microfacet-Based Shadowing Function to Solve the Bump Terminator
// Problem", 2019), or, as Cycles had it before, a cubic of what Chiang et al. clip (2019).
float lit_share_of_bump(vec3 straight, vec3 bent, vec3 to_light) {
  float light = dot(straight, to_light);
  float across = dot(straight, bent);
#ifdef FACETS_SHADE_BUMPS
  if (light <= 0.0) return 0.0;
  float alpha = min(sqrt(0.125 * max(1.0 / max(across * across, 1e-8) - 1.0, 0.0)), 1.0);
  return 2.0 * light / (light + ggx_smith_root(light, alpha));
#else
  float g = light / max(dot(bent, to_light) * across, 1e-8);
  if (g <= 0.0) return 0.0;  // where the cubic rises again
  return g >= 1.0 ? 1.0 : g * (1.0 + g - g * g);
#endif
}
#endif

#ifdef TEXTURED
void put_on(inout SurfacePoint point) {
#ifdef NORMAL_MAP
  unbent_normal = bent_normal = point.normal;
  if (surface_tangent.w == 0.0) return;
  vec3 told = 2.0 * looked_up(normal_picture, normal_map) - 1.0;
  told = vec3(told.xy * material.normal_strength, mix(1.0, told.z, clamp(material.normal_strength, 0.0, 1.0)));
  vec3 along_v = surface_tangent.w * cross(point.normal, surface_tangent.xyz);
  vec3 bent = told.x * surface_tangent.xyz + told.y * along_v + told.z * point.normal;
  if (dot(bent, bent) == 0.0) return;
  bent_normal = normalize(bent);
  point.normal = with_valid_reflection(unbent_normal, point.to_viewer, bent_normal);
#ifndef BENT_NORMALS_STAY
  bent_normal = point.normal;
#endif
#endif
}
#endif

#ifdef EMITS
vec3 emitted() {
#ifdef EMISSION_MAP
  return material.radiance * looked_up(emission_picture, emission_map);
#else
  return material.radiance;
#endif
}
#endif

#ifdef FACETS_KEEP_ENERGY
// What to multiply one bounce by for all of them: of light from everywhere facets without loss send `once` after one, on average `mean`, and
// each bounce absorbs what is not in `reflectance` (Kulla and Conty, "Revisiting Physically Based Shading at Imageworks", 2017, for the bounces'
// colour; Turquin, "Practical multiple scattering compensation for microfacet models", 2019, for their directions).
vec3 kept(vec3 reflectance, float once, float mean) {
  vec3 further = reflectance * mean / (1.0 - reflectance * (1.0 - mean));
  return 1.0 + further * (1.0 - once) / once;
}
#endif

Outwards look_outwards(SurfacePoint point) {
#ifdef REFLECTANCE_MAP
  point_reflectance = clamp(looked_up(reflectance_picture, reflectance_map), 0.0, 1.0);
#else
  point_reflectance = material.reflectance;
#endif
#ifdef ROUGHNESS_MAP
  float roughness = mean_of(looked_up(roughness_picture, roughness_map));
#else
  float roughness = material.roughness;
#endif
  point_alpha = max(roughness * roughness, GGX_SMALLEST_ALPHA);
#ifdef METALLIC_MAP
  point_metallicity = mean_of(looked_up(metallic_picture, metallic_map));
#else
  point_metallicity = material.metallicity;
#endif
  float mu = clamp(dot(point.normal, point.to_viewer), 0.0, 1.0);
  metal_kept = coat_kept = vec3(1.0);
  base_seen = 1.0;
#ifdef FACET_ENERGY
  vec2 texels = vec2(textureSize(facet_energy, 0));
  vec3 sent = texture(facet_energy, (vec2(sqrt(mu), roughness) * (texels - 1.0) + 0.5) / texels).rgb;
#ifdef FACETS_KEEP_ENERGY
#ifdef METAL_WHITENS
  metal_kept = kept(mix(point_reflectance, vec3(1.0), 1.0 / 21.0), sent.r, sent.b);  // Schlick's mean
#else
  metal_kept = kept(point_reflectance, sent.r, sent.b);
#endif
  coat_kept = kept(vec3(material.coat_mean), sent.r, sent.b);
#endif
#ifdef COAT_SHADES_BASE
  base_seen = clamp(1.0 - sent.g * coat_kept.r, 0.0, 1.0);
#endif
#endif
  return Outwards(mu, mu, 1.0);
}

#if defined(METALLIC) || defined(COAT)
float facet_alpha() { return point_alpha; }

vec3 facet_reflectance(float mu_h) {
  vec3 metal = vec3(0.0);
  vec3 coat = vec3(0.0);
  float grazing = 0.0;
#ifdef METALLIC
  metal = point_metallicity * metal_kept;
#endif
#ifdef COAT
  coat = (1.0 - point_metallicity) * coat_kept;
  // How far from straight on to grazing a dielectric of this reflectance is: Cycles' mixing of colours by Fresnel's formula.
  float root = sqrt(min(material.coat, 0.99));
  float eta = (1.0 + root) / (1.0 - root);
  grazing = (fresnel_reflectance(mu_h, eta) - material.coat) / (1.0 - min(material.coat, 0.99));
#endif
#ifdef METAL_WHITENS
  return metal * mix(point_reflectance, vec3(1.0), pow(1.0 - mu_h, 5.0)) + coat * mix(material.coat, 1.0, grazing);
#else
  vec3 straight = metal * point_reflectance + coat * material.coat;
  return straight + grazing * (1.0 - straight);
#endif
}

float facets(SurfacePoint point, vec3 half_vector, float mu_i, float mu_o) {
#ifdef MASKING_SEPARABLE
  float visibility = ggx_visibility_separable(mu_i, mu_o, point_alpha);
#else
  float visibility = ggx_visibility_correlated(mu_i, mu_o, point_alpha);
#endif
  return ggx_distribution(point.normal, half_vector, point_alpha) * visibility;
}
#endif

#ifdef ROUGH_DIFFUSE
// Over Lambert's, after one bounce in V-shaped cavities (Oren and Nayar, "Generalization of Lambert's Reflectance Model", 1994): Fujii, "A tiny
// improvement of Oren-Nayar reflectance model", 2012, with a roughness from 0 to 1. `cosine`: between light and viewer.
float oren_nayar(float mu_i, float mu_o, float cosine) {
  float aside = cosine - mu_i * mu_o;
  if (aside > 0.0) aside /= max(max(mu_i, mu_o), 1e-6);
  return (1.0 + material.diffuse_roughness * aside) / (1.0 + (0.5 - 2.0 / (3.0 * PI)) * material.diffuse_roughness);
}
#endif

vec3 evaluate_model(SurfacePoint point, Outwards outwards, LightSample light) {
  float mu_i = dot(point.normal, light.to_light);
#ifdef NORMAL_MAP
  float diffuse_mu_i = dot(bent_normal, light.to_light);
#else
  float diffuse_mu_i = mu_i;
#endif
  if (max(mu_i, diffuse_mu_i) <= 0.0) return vec3(0.0);
  float mu_o = outwards.mu;
  vec3 sum = light.to_light + point.to_viewer;
  vec3 half_vector = sum * inversesqrt(max(dot(sum, sum), 1e-12));
  float mu_h = clamp(dot(half_vector, light.to_light), 0.0, 1.0);
  vec3 diffuse = point_reflectance * (1.0 / PI);
#ifdef RETRO_REFLECTIVE
  // Burley, "Physically Based Shading at Disney", 2012, section 5.3.
  float at_grazing = 0.5 + 2.0 * mu_h * mu_h * sqrt(point_alpha);
  diffuse *= (1.0 + (at_grazing - 1.0) * pow(1.0 - diffuse_mu_i, 5.0)) * (1.0 + (at_grazing - 1.0) * pow(1.0 - mu_o, 5.0));
#endif
#ifdef ROUGH_DIFFUSE
#ifdef NORMAL_MAP
  float diffuse_mu_o = max(dot(bent_normal, point.to_viewer), 0.0);
#else
  float diffuse_mu_o = mu_o;
#endif
  diffuse *= oren_nayar(max(diffuse_mu_i, 0.0), diffuse_mu_o, dot(light.to_light, point.to_viewer));
#endif
  diffuse *= base_seen * max(diffuse_mu_i, 0.0);
#ifdef METALLIC
  diffuse *= 1.0 - point_metallicity;
#endif
#ifdef NORMAL_MAP
  diffuse *= lit_share_of_bump(unbent_normal, bent_normal, light.to_light);
#endif
#if defined(METALLIC) || defined(COAT)
  float of_facets = mu_i > 0.0 ? mu_i * facets(point, half_vector, mu_i, mu_o) : 0.0;
#if defined(NORMAL_MAP) && defined(FACETS_SHADE_BUMPS)
  if (dot(unbent_normal, light.to_light) <= 0.0) of_facets = 0.0;
#endif
#ifdef MIRRORS_WORLD
  of_facets *= share_of_light(point, light, mu_o);
#endif
  vec3 specular = facet_reflectance(mu_h) * of_facets;
#else
  const vec3 specular = vec3(0.0);
#endif
  return (portion(DIFFUSE_PORTION, diffuse) + portion(SPECULAR_PORTION, specular)) * light.irradiance;
}

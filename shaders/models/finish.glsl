// An opaque surface that is no grain: Lambertian or Burley's diffuse under a dielectric coat, a rough conductor, what lies between them; worn
// pictures; light of its own.
//
// What is chosen at compile time:
//   REFLECTANCE_MAP, ROUGHNESS_MAP, METALLIC_MAP, NORMAL_MAP, EMISSION_MAP   a picture says it
//   METALLIC            some of it is a conductor
//   COAT                the rest has a coat
//   COAT_SHADES_BASE    and lets through what it does not reflect
//   RETRO_REFLECTIVE    the diffuse share is Burley's
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
  float coat;  // reflectance seen straight on
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

// Of the point that is shaded, once for all lights.
vec3 point_reflectance;
float point_alpha;
float point_metallicity;

#ifdef NORMAL_MAP
vec3 unbent_normal;

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
// Problem", 2019, in Cycles' cubic form).
float lit_share_of_bump(vec3 straight, vec3 bent, vec3 to_light) {
  float g = dot(straight, to_light) / max(dot(bent, to_light) * dot(straight, bent), 1e-8);
  return g >= 1.0 ? 1.0 : max(g * (1.0 + g - g * g), 0.0);
}
#endif

#ifdef TEXTURED
void put_on(inout SurfacePoint point) {
#ifdef NORMAL_MAP
  unbent_normal = point.normal;
  if (surface_tangent.w == 0.0) return;
  vec3 told = 2.0 * looked_up(normal_picture, normal_map) - 1.0;
  told = vec3(told.xy * material.normal_strength, mix(1.0, told.z, clamp(material.normal_strength, 0.0, 1.0)));
  vec3 along_v = surface_tangent.w * cross(point.normal, surface_tangent.xyz);
  vec3 bent = told.x * surface_tangent.xyz + told.y * along_v + told.z * point.normal;
  if (dot(bent, bent) > 0.0) point.normal = with_valid_reflection(unbent_normal, point.to_viewer, normalize(bent));
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
  return Outwards(mu, mu, 1.0);
}

#if defined(METALLIC) || defined(COAT)
float facet_alpha() { return point_alpha; }

vec3 facet_reflectance(float mu_h) {
  vec3 straight = vec3(0.0);
  float grazing = 0.0;
#ifdef METALLIC
  straight += point_metallicity * point_reflectance;
#endif
#ifdef COAT
  straight += (1.0 - point_metallicity) * material.coat;
  // How far from straight on to grazing a dielectric of this reflectance is: Cycles' mixing of colours by Fresnel's formula.
  float root = sqrt(min(material.coat, 0.99));
  float eta = (1.0 + root) / (1.0 - root);
  grazing = (fresnel_reflectance(mu_h, eta) - material.coat) / (1.0 - min(material.coat, 0.99));
#endif
  return straight + grazing * (1.0 - straight);
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

#ifdef COAT_SHADES_BASE
// Of light from everywhere, that rough facets of this reflectance seen straight on send to a viewer at the cosine mu (Karis, "Physically
// Based Shading on Mobile", 2014, a fit of Lazarov's).
float reflected_by_facets(float straight, float roughness, float mu) {
  vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
  float a = min(r.x * r.x, exp2(-9.28 * mu)) * r.x + r.y;
  vec2 scale_and_bias = vec2(-1.04, 1.04) * a + r.zw;
  return clamp(straight * scale_and_bias.x + scale_and_bias.y, 0.0, 1.0);
}
#endif

vec3 evaluate_model(SurfacePoint point, Outwards outwards, LightSample light) {
  float mu_i = dot(point.normal, light.to_light);
  if (mu_i <= 0.0) return vec3(0.0);
  float mu_o = outwards.mu;
  vec3 sum = light.to_light + point.to_viewer;
  vec3 half_vector = sum * inversesqrt(max(dot(sum, sum), 1e-12));
  float mu_h = clamp(dot(half_vector, light.to_light), 0.0, 1.0);
  vec3 diffuse = point_reflectance * (1.0 / PI);
#ifdef RETRO_REFLECTIVE
  // Burley, "Physically Based Shading at Disney", 2012, section 5.3.
  float at_grazing = 0.5 + 2.0 * mu_h * mu_h * sqrt(point_alpha);
  diffuse *= (1.0 + (at_grazing - 1.0) * pow(1.0 - mu_i, 5.0)) * (1.0 + (at_grazing - 1.0) * pow(1.0 - mu_o, 5.0));
#endif
#ifdef COAT_SHADES_BASE
  diffuse *= 1.0 - reflected_by_facets(material.coat, sqrt(point_alpha), mu_o);
#endif
#ifdef METALLIC
  diffuse *= 1.0 - point_metallicity;
#endif
#ifdef NORMAL_MAP
  diffuse *= lit_share_of_bump(unbent_normal, point.normal, light.to_light);
#endif
#if defined(METALLIC) || defined(COAT)
  float of_facets = facets(point, half_vector, mu_i, mu_o);
#ifdef MIRRORS_WORLD
  of_facets *= share_of_light(point, light, mu_o);
#endif
  vec3 specular = facet_reflectance(mu_h) * of_facets;
#else
  const vec3 specular = vec3(0.0);
#endif
  return (portion(DIFFUSE_PORTION, diffuse) + portion(SPECULAR_PORTION, specular)) * light.irradiance * mu_i;
}

// Model 2: one look into the light map. Model 1's half-space, corrected by how a sphere of the same medium differs from it: the sphere whose
// chord along the light and whose normal are those of this point. Its light passes through and around, so the unlit side glows.
// Not physical: the rest of the grain's shape is not seen, and what the sphere has beyond the half-space leaves evenly, like diffuse light.
//
// What is chosen at compile time (physics::model_2_inputs), besides what half_space_light.glsl names:
//   SEPARATE_SINGLE      `single_difference`: anisotropic first-order scattering has a table of its own
#include "models/half_space_light.glsl"
#include "models/interface.glsl"
#include "models/light_map.glsl"

struct Body {
  float radius;  // of the sphere with the grain's mean chord
  float exit_slope;
  float exit_factor;  // diffused light leaves as factor (1 + slope mu') times the transmittance, mu' inside
};
uniform Body body;

uniform sampler2D body_difference;
#ifdef SEPARATE_SINGLE
uniform sampler2D single_difference;
#endif

// Row of the tables: an eighth of the grain's radius to its double, evenly in the logarithm.
float radius_coordinate(float radius_ratio) { return clamp((log2(max(radius_ratio, 1e-6)) + 3.0) * 0.25, 0.0, 1.0); }

float cosine_coordinate(float cosine) { return 0.5 + 0.5 * sign(cosine) * sqrt(min(abs(cosine), 1.0)); }

vec3 look_up(sampler2D table, vec2 coordinate) {
  vec2 size = vec2(textureSize(table, 0));
  return texture(table, (coordinate * (size - 1.0) + 0.5) / size).rgb;
}

// Where the body has less light than the half-space, the half-space's is dimmed; where it has more, the rest leaves by `lobe`.
vec3 corrected(vec3 half_space, vec3 difference, vec3 lobe) {
  return half_space * (1.0 + min(difference, 0.0)) + max(difference, 0.0) * lobe;
}

vec3 evaluate_model(SurfacePoint point, LightSample light) {
  vec3 position = to_light_space(light.index, point.position);
  float cosine = dot(point.normal, light.to_light);
  LightMapTexel entry = light_map_at(light.index, position.xy);

  float above = entry.lit ? max(entry.position.z - position.z, 0.0) : 0.0;
  float own = light_map_tolerance(light.index, entry.normal);
  float visible = light_map_visibility(light.index, entry, position, cosine);
  float way_in = mix(above, max(position.z - entry.exit_depth, 0.0), entry.lit ? visible : 0.0);

  // A sphere of radius r has chords 2 r |cosine|. Where both vanish, and where the map is too coarse to tell, the grain's own radius stands in.
  float uncertainty = 0.05 + (entry.lit ? min(own / body.radius, 1.0) : 1.0);
  float radius_ratio = (0.5 * way_in / body.radius + uncertainty) / (abs(cosine) + uncertainty);
  float side = mix(-abs(cosine), cosine, visible);
  vec2 coordinate = vec2(cosine_coordinate(side), radius_coordinate(radius_ratio));

  float mu_o = clamp(dot(point.normal, point.to_viewer), 0.0, 1.0);
#ifdef REFRACTION
  float mu_o_refracted = refracted_cosine(mu_o, material.eta);
  float transmittance = surface_transmittance(mu_o, mu_o_refracted);
#else
  float mu_o_refracted = mu_o;
  const float transmittance = 1.0;
#endif
  vec3 lobe = light.irradiance * (transmittance * body.exit_factor * (1.0 + body.exit_slope * mu_o_refracted));

  HalfSpaceLight half_space = half_space_light(point, light);
  vec3 radiance = corrected(visible * half_space.multiple, look_up(body_difference, coordinate), lobe);
#ifdef SEPARATE_SINGLE
  vec3 out_of = refract(-point.to_viewer, point.normal, sqrt(material.inverse_eta_squared));
  vec3 sum = out_of - material.sign_g * light.to_light;
  float versine = 0.5 * dot(sum, sum);
  float phase = 4.0 * PI * henyey_greenstein(versine, material.absolute_g, material.one_minus_absolute_g);
  radiance += corrected(visible * half_space.single, look_up(single_difference, coordinate), phase * lobe);
#endif
#ifdef SPECULAR
  radiance += visible * specular_reflection(point, light);
#endif
  return radiance;
}

// What models 2 and 3 share: the sphere of the grain's medium whose chord along the light and whose normal are those of a point, and the
// light that such a sphere sends out there. Its light passes through and around, so the unlit side glows.
//
// What is chosen at compile time (physics::add_body, physics::add_planar_body), besides what half_space_light.glsl names:
//   PLANAR_PROFILE       `body_light` holds a profile's integral over the sphere; else the sphere's difference from the half-space
#include "models/dielectric.glsl"
#include "models/interface.glsl"
#include "models/light_map.glsl"
#include "models/pixel_random.glsl"
#include "physics/prelude.glsl"
#include "physics/fresnel.glsl"
#include "physics/half_space.glsl"
#include "physics/henyey_greenstein.glsl"
// A file is pasted once, where it is met first: what this one includes must stand above, outside the condition.
#ifndef PLANAR_PROFILE
#include "models/half_space_light.glsl"
#endif

struct Body {
  float radius;  // of the sphere with the grain's mean chord
  float clear;   // what light passes through nearly unhindered, in scene units
  float eta;
  float exit_slope;
  float exit_factor;  // diffused light leaves as factor (1 + slope mu') times the transmittance, mu' inside
  float even_factor;  // light that is even inside leaves as factor times the transmittance
};
uniform Body body;

// Columns: cosine; rows: radius. Alpha: how much of the diffused light flows along the surface, away from the light.
uniform sampler2D body_table;

struct BodyFit {
  float cosine;   // between normal and light; negative where something stands in the light
  float visible;  // 0 or 1, smooth at the edge of a shadow
  float radius;   // of the sphere, over the grain's
  float above;    // depth below the surface that the light meets first, in scene units
  float mu_o;
  float mu_o_refracted;
  float transmittance;  // towards the viewer
};

BodyFit fit_body(SurfacePoint point, Outwards outwards, LightSample light, LightFrame frame) {
  BodyFit fit;
  vec3 position = to_light_space(frame, point.position);
  float cosine = dot(point.normal, light.to_light);
  // Light inside knows no edge sharper than a mean free path: the look is at a place nearby on the tangent plane, another with every sample.
  vec2 along = body.clear * (2.0 * low_discrepancy(uint(sample_index), pcg4d(uvec4(uvec2(gl_FragCoord.xy), 1u, uint(light.index))).xy) - 1.0);
  vec3 aside = vec3(abs(cosine) * along, -sign(cosine) * dot(to_light_space(frame, point.normal).xy, along));
  vec3 place = position + aside;
  LightMapTexel entry = light_map_at(frame, light.index, place.xy);

  // Beside the silhouette that this place is on, the texel shows what lies far behind: it tells no more than one that shows nothing.
  float own = light_map_tolerance(frame, entry.normal.z);
  // The surface itself bends away from its tangent plane, and a fine map shows it: twice as far as the grain's sphere is no silhouette yet.
  float bent = own + dot(aside, aside) / (body.radius * max(abs(cosine), 0.2));
  float known = entry.lit ? smoothstep(-2.0 * bent, -bent, entry.position.z - place.z) : 0.0;

  fit.above = entry.lit ? max(entry.position.z - place.z, 0.0) : 0.0;
  fit.visible = light_map_visibility(frame, entry, place, cosine, body.clear);
  float way_in = mix(fit.above, max(entry.position.z - entry.exit_depth, 0.0), known * fit.visible);

  // A sphere of radius r has chords 2 r |cosine|. Where both vanish, and where the map is too coarse to tell, the grain's own radius stands
  // in.
  float uncertainty = 0.05 + mix(1.0, min(own / body.radius, 1.0), known);
  float steepness = mix(abs(cosine), entry.normal.z, known);
  fit.radius = clamp((0.5 * way_in / body.radius + uncertainty) / (steepness + uncertainty), 0.125, 2.0);
  fit.cosine = mix(-abs(cosine), cosine, fit.visible);

  fit.mu_o = outwards.mu;
  fit.mu_o_refracted = outwards.mu_refracted;
  fit.transmittance = outwards.transmittance;
  return fit;
}

vec4 look_up_body(sampler2D table, BodyFit fit) {
  // The terminator is where light changes fastest; radii go from an eighth of the grain's to its double, evenly in the logarithm.
  vec2 coordinate = vec2(0.5 + 0.5 * sign(fit.cosine) * sqrt(min(abs(fit.cosine), 1.0)), (log2(fit.radius) + 3.0) * 0.25);
  vec2 size = vec2(textureSize(table, 0));
  return texture(table, (coordinate * (size - 1.0) + 0.5) / size);
}

// Radiance per exitance of diffused light.
float diffused_lobe(BodyFit fit) { return fit.transmittance * body.exit_factor * (1.0 + body.exit_slope * fit.mu_o_refracted); }

#ifndef PLANAR_PROFILE
// Light that fades with distance as exp(-flow s) along a surface has radiance ~ 1/(1 - flow cos) about that direction (the asymptotic
// solution of the transport equation, Case and Zweifel 1967, section 4.3); over its mean for all azimuths.
float flow_along_surface(BodyFit fit, SurfacePoint point, LightSample light, float flow) {
  float sine_o = sqrt(max((1.0 - fit.mu_o_refracted) * (1.0 + fit.mu_o_refracted), 0.0));
  float cosine = dot(point.normal, light.to_light);
  float sine = sqrt(max((1.0 - cosine) * (1.0 + cosine), 1e-6));
  float along = clamp((cosine * fit.mu_o - dot(point.to_viewer, light.to_light)) / (sine * body.eta), -sine_o, sine_o);
  return sqrt(max(1.0 - flow * flow * sine_o * sine_o, 0.0)) / (1.0 - flow * along);
}

// Where the body has less light than the half-space, the half-space's is dimmed; where it has more, the rest leaves by `lobe`.
vec3 corrected(vec3 half_space, vec3 difference, vec3 lobe) {
  return half_space * (1.0 + min(difference, 0.0)) + max(difference, 0.0) * lobe;
}
#endif

// What models 2 and 3 share: the sphere of the grain's medium whose chord along the light and whose normal are those of a point, and the
// light that such a sphere sends out there. Its light passes through and around, so the unlit side glows.
//
// What is chosen at compile time (physics::add_body, physics::add_planar_body), besides what half_space_light.glsl names:
//   GREY                 red, green and blue are the same medium, and only one is computed
//   PLANAR_PROFILE       `body_light` holds a profile's integral over the sphere; else the sphere's difference from the half-space
#include "models/clear_sphere.glsl"
#include "models/dielectric.glsl"
#include "models/interface.glsl"
#include "models/light_map.glsl"
#include "models/pixel_random.glsl"
#include "physics/prelude.glsl"
#include "physics/fresnel.glsl"
#include "physics/half_space.glsl"
#include "physics/henyey_greenstein.glsl"
#include "physics/tables.glsl"
// A file is pasted once, where it is met first: what this one includes must stand above, outside the condition.
#ifndef PLANAR_PROFILE
#include "models/half_space_light.glsl"
#endif

#ifdef GREY
#define Spectrum float
#define SPECTRUM(value) (value).r
#else
#define Spectrum vec3
#define SPECTRUM(value) (value).rgb
#endif

struct Body {
  float radius;  // of the sphere with the grain's mean chord
  float clear;   // what light passes through nearly unhindered, in scene units
  float eta;
  float exit_slope;
  float exit_factor;   // diffused light leaves as factor (1 + slope mu') times the transmittance, mu' inside
  vec3 decay_squared;  // of light far from where it entered, per reduced mean free path
  float even_factor;   // light that is even inside leaves as factor times the transmittance
};
uniform Body body;

// Columns: cosine; rows: radius. Alpha: red's flow.
uniform sampler2D body_table;
#if !defined(GREY) && !defined(PLANAR_PROFILE)
// As body_table. How fast the light inside fades along the surface, away from where it came in, per reduced mean free path.
uniform sampler2D flow_table;
#endif

struct BodyFit {
  float cosine;   // between normal and light; negative where something stands in the light
  float facing;   // the same of the direction from which the light's map shows the grain
  float visible;  // 0 or 1, smooth at the edge of a shadow
  float reached;  // what other objects leave of the light where it meets the surface above the point
  float entered;  // and of what leaves the body at the point, where that came in
  float radius;   // of the sphere, over the grain's
  float above;    // depth below the surface that the light meets first, in scene units
  float mu_o;
  float mu_o_refracted;
  float transmittance;  // towards the viewer
};

BodyFit fit_body(SurfacePoint point, Outwards outwards, LightSample light, LightFrame frame) {
  BodyFit fit;
  vec3 position = to_light_space(frame, point.position);
  float cosine = dot(point.normal, frame.z_axis);
  // Light inside knows no edge sharper than a mean free path: the look is at a place nearby on the tangent plane, another with every sample.
  vec2 along = body.clear * (2.0 * low_discrepancy(uint(sample_index), pcg4d(uvec4(uvec2(gl_FragCoord.xy), 1u, uint(light.index))).xy) - 1.0);
  vec3 aside = vec3(abs(cosine) * along, -sign(cosine) * dot(to_light_space(frame, point.normal).xy, along));
  vec3 place = position + aside;
  LightMapTexel entry = light_map_at(frame, light.map, place.xy);

  // Beside the silhouette that this place is on, the texel shows what lies far behind: it tells no more than one that shows nothing.
  float own = light_map_tolerance(frame, entry.normal.z);
  // The surface itself bends away from its tangent plane, and a fine map shows it: twice as far as the grain's sphere is no silhouette yet.
  float bent = own + dot(aside, aside) / (body.radius * max(abs(cosine), 0.2));
  float known = entry.lit ? smoothstep(-2.0 * bent, -bent, entry.position.z - place.z) : 0.0;

  fit.above = entry.lit ? max(entry.position.z - place.z, 0.0) : 0.0;
  fit.visible = light_map_visibility(frame, entry, place, cosine, body.clear);
  fit.reached = light_reaches_entry(frame, entry.lit ? entry.position : place);
  fit.entered = entered < 0.0 ? fit.reached : entered;
  float way_in = mix(fit.above, max(entry.position.z - entry.exit_depth, 0.0), known * fit.visible);

  // A sphere of radius r has chords 2 r |cosine|. Where both vanish, and where the map is too coarse to tell, the grain's own radius stands
  // in.
  float uncertainty = 0.05 + mix(1.0, min(own / body.radius, 1.0), known);
  // In the shade it is the surface's own tilt that counts, at the place where a sphere would be: that of the lit surface above jumps at
  // its edges, which would show as hard shadows of them.
  float bent_cosine = (cosine + aside.z / body.radius) * inversesqrt(1.0 + dot(aside, aside) / (body.radius * body.radius));
  float steepness = mix(abs(bent_cosine), entry.normal.z, known * fit.visible);
  fit.radius = clamp((0.5 * way_in / body.radius + uncertainty) / (steepness + uncertainty), 0.125, 2.0);
  fit.facing = mix(-abs(cosine), cosine, fit.visible);
#ifdef NEAR_LIGHTS
  float own_cosine = dot(point.normal, light.to_light);
  fit.cosine = mix(-abs(own_cosine), own_cosine, fit.visible);
#else
  fit.cosine = fit.facing;
#endif

  fit.mu_o = outwards.mu;
  fit.mu_o_refracted = outwards.mu_refracted;
  fit.transmittance = outwards.transmittance;
  return fit;
}

vec4 look_up_body(sampler2D table, BodyFit fit) {
  vec2 coordinate = vec2(body_column(fit.cosine), body_row(fit.radius));
  vec2 size = vec2(textureSize(table, 0));
  return texture(table, (coordinate * (size - 1.0) + 0.5) / size);
}

// Radiance per exitance of diffused light.
float diffused_lobe(BodyFit fit) { return fit.transmittance * body.exit_factor * (1.0 + body.exit_slope * fit.mu_o_refracted); }

#ifndef PLANAR_PROFILE
Spectrum flow_at(BodyFit fit, vec4 table) {
#ifdef GREY
  return table.a;
#else
  return look_up_body(flow_table, fit).rgb;
#endif
}

// The same of light that fades with depth and along the surface: what leaves slantwise comes from beside (physics::FlowingLobe).
Spectrum flowing_lobe(BodyFit fit, SurfacePoint point, LightSample light, Spectrum flow) {
  float mu = fit.mu_o_refracted;
  float sine_o = sqrt(max((1.0 - mu) * (1.0 + mu), 0.0));
  float cosine = dot(point.normal, light.to_light);
  float sine = sqrt(max((1.0 - cosine) * (1.0 + cosine), 1e-6));
  float along = clamp((cosine * fit.mu_o - dot(point.to_viewer, light.to_light)) / (sine * body.eta), -sine_o, sine_o);
  Spectrum p = 1.0 - flow * along;
  Spectrum q_squared = SPECTRUM(body.decay_squared) - flow * flow;
  return fit.transmittance * body.exit_factor * (p + body.exit_slope * mu) / (p * p - q_squared * (mu * mu));
}

// Where the body has less light than the half-space, the half-space's is dimmed; where it has more, the rest leaves by `lobe`.
vec3 corrected(vec3 half_space, vec3 difference, vec3 lobe) { return half_space * (1.0 + min(difference, 0.0)) + max(difference, 0.0) * lobe; }
#endif

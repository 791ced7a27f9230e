// Light that was scattered once on the way that the view ray takes through the grain, by samples of that way and of the light's map above each;
// of models that define SINGLE_MARCHED.
#include "models/body_light.glsl"
#include "models/lamp_at_entries.glsl"
#include "models/lit_surface.glsl"
#include "physics/prelude.glsl"
#include "physics/elementary.glsl"
#include "physics/fresnel.glsl"
#include "physics/henyey_greenstein.glsl"

#ifdef SINGLE_MARCHED
struct Single {
  vec3 sigma_s;  // per grain radius, as every length here
  vec3 sigma_t;
  float absolute_g;
  float one_minus_absolute_g;
  float sign_g;
#ifdef FORWARD_PEAK
  vec3 peak;  // of sigma_s, not in sigma_t; see physics::ForwardPeak
  float rest;
  float rest_g;
#endif
};
uniform Single single;
uniform sampler2D refracted_light;

vec4 at_nodes(sampler2D table, vec2 coordinate) {
  vec2 size = vec2(textureSize(table, 0));
  return texture(table, (coordinate * (size - 1.0) + 0.5) / size);
}

// Where the light that reaches a point inside the grain came in.
struct Entry {
  float lit;    // 0 or 1; between them where the map can't tell
  float above;  // how far above the point, over the grain's radius
  vec3 normal;
};

// By the map, but by the sphere that fits where the map can't tell them apart.
Entry entry_above(LightMapTexel mapped, LightFrame frame, vec3 point, vec3 centre, float radius) {
  float map_above = mapped.position.z / body.radius - point.z;
  vec2 from_axis = point.xy - centre.xy;
  float height = sqrt(max(radius * radius - dot(from_axis, from_axis), 0.0));
  float sphere_above = centre.z + height - point.z;
  vec3 sphere_normal = vec3(from_axis, height) / radius;

  float same = distance(point, centre) < radius ? is_sphere(frame, mapped, centre.z + height, length(from_axis), radius, sphere_normal.z) : 0.0;

  float tolerance = light_map_tolerance(frame, mapped.normal.z) / body.radius;
  float inside = mapped.lit && point.z * body.radius >= mapped.exit_depth && map_above >= -tolerance ? 1.0 : 0.0;
  Entry entry;
  entry.lit = mix(inside, 1.0, same);
  entry.above = mapped.lit ? mix(map_above, sphere_above, same) : sphere_above;
  entry.normal = mapped.lit ? normalize(mix(mapped.normal, sphere_normal, same)) : sphere_normal;
  return entry;
}

// Light that has come in, at a point inside, before it is scattered.
struct LightInside {
  float irradiance;  // per irradiance outside
  float way_in;      // over the grain's radius
  vec3 direction;    // in which it goes
};

// Of light from `to_light` that would have entered `above` the point, straight, on a surface of this normal: at the place in the unit sphere that has
// this normal so far above it.
LightInside light_inside(vec3 to_light, vec3 normal, float above) {
  float facing = max(dot(normal, to_light), 0.0);
  vec3 aside = normal - facing * to_light;
  float tilt = length(aside);
  float depth = clamp(above, 0.0, 2.0 * facing);
  float z = facing - depth;
  vec3 lighting = at_nodes(refracted_light, vec2(min(tilt * inversesqrt(max((1.0 - z) * (1.0 + z), 1e-8)), 1.0), 0.5 + 0.5 * z)).rgb;
  vec3 sideways = tilt > 1e-6 ? lighting.z / tilt * aside : vec3(0.0);
  return LightInside(lighting.x, lighting.y * depth + max(above - depth, 0.0),
                     sideways - sqrt(max((1.0 - lighting.z) * (1.0 + lighting.z), 0.0)) * to_light);
}

// What of it is scattered towards the viewer; `inwards`: the refracted view ray.
Spectrum scattered_towards(LightInside light, vec3 inwards) {
  vec3 turn = light.direction + single.sign_g * inwards;
  float phase = light.irradiance * henyey_greenstein(0.5 * dot(turn, turn), single.absolute_g, single.one_minus_absolute_g);
#ifdef FORWARD_PEAK
  // Light that has met the peak before is scattered by the rest alone.
  float rest = light.irradiance * single.rest * henyey_greenstein(0.5 * dot(turn, turn), single.rest_g, 1.0 - single.rest_g);
  return mix(Spectrum(rest), Spectrum(phase), exp(-SPECTRUM(single.peak) * light.way_in));
#else
  return Spectrum(phase);
#endif
}

#ifdef LIGHTS_ABOUT
// A third look comes nearer to the place, and no nearer to the truth: the spreading of the lamp's light on its way in is left out, too
// (docs/scenes.md). A ball under a spot is 5.3 % off with it, not 3.4, an irregular grain 5.8, not 6.1.
const int LOOKS_FOR_ENTRY = 2;

// Of a lamp that is near, per emission. `entry`: above the point, as the light's map has it; where the lamp's light came in is looked for from there.
LightInside lamp_inside(Seen seen, Entry entry, vec3 point, vec3 centre) {
  vec3 enters = point + vec3(0.0, 0.0, entry.above);
  LampThere there = lamp_there(seen.frame, body.radius * enters);
  for (int look = 0; look < LOOKS_FOR_ENTRY; ++look) {
    float along = dot(enters - point, entry.normal) / max(dot(there.to_lamp, entry.normal), LEAST_COSINE);
    vec3 place = vec3((point + along * there.to_lamp).xy, point.z);
    Entry other = entry_above(light_map_at(seen.frame, seen.map, place.xy * body.radius), seen.frame, place, centre, seen.fit.radius);
    if (other.lit == 0.0) break;
    entry = other;
    enters = place + vec3(0.0, 0.0, entry.above);
    there = lamp_there(seen.frame, body.radius * enters);
  }
  float facing = dot(there.to_lamp, entry.normal);
  LightInside inside = light_inside(there.to_lamp, entry.normal, max(dot(enters - point, entry.normal), 0.0) / max(facing, LEAST_COSINE));
  inside.irradiance *= facing > 0.0 ? there.irradiance : 0.0;
  return inside;
}
#endif

// Of light that was scattered once on the view ray's way through the grain: radiance inside, just below the surface.
struct ScatteredOnce {
  vec3 parallel;  // per irradiance
  vec3 lamp;      // per emission of a lamp that is near
};

// `inwards`: the refracted view ray, light space.
ScatteredOnce single_scattering(Seen seen, vec3 inwards, Draws draws) {
  LightFrame frame = seen.frame;
  BodyFit fit = seen.fit;
  vec3 position = seen.position;

  // No farther than through the ball that holds the grain. Rounding may leave a point on the silhouette outside, which has no way at all.
  float reach = grain_reach / body.radius;
  float along = dot(position, inwards);
  vec3 centre = position - fit.radius * seen.fit_normal;
  float longest = max(sqrt(max(along * along + reach * reach - dot(position, position), 0.0)) - along, 0.0);

  // How fast the light's way in grows along the view ray where that begins: as below a plane that is tilted like the entry above the point,
  // or, where light grazes it, like a sphere a mean free path below the surface.
  float mu_i = refracted_cosine(abs(fit.facing), body.eta);
  float tilted = fit.mu_o_refracted - (fit.facing < 0.0 ? 2.0 * mu_i * inwards.z : 0.0);
  Spectrum sigma_t = SPECTRUM(single.sigma_t);
  Spectrum steepness = mu_i + sqrt(mu_i * mu_i + 2.0 / max(sigma_t * fit.radius, Spectrum(1e-6)));
  Spectrum rate = max(sigma_t * (1.0 + 2.0 * tilted / steepness), Spectrum(0.0));

  // What each channel's exponential leaves of the way, over the way itself.
  Spectrum thickness = rate * longest;
#ifdef GREY
  float mean_way = longest * mean_attenuation(thickness);
#else
  vec3 mean_way = longest * vec3(mean_attenuation(thickness.r), mean_attenuation(thickness.g), mean_attenuation(thickness.b));
#endif

  float shift = low_discrepancy(draws.first, draws.offset).x;
  Spectrum sum = Spectrum(0.0);
  Spectrum of_lamp = Spectrum(0.0);
  Spectrum plane = Spectrum(0.0);
  int i = 0;
  do {
    float random = min((float(i) + shift) / float(draws.count), LARGEST_BELOW_ONE);
#ifdef GREY
    vec2 chosen = vec2(rate, mean_way);
#else
    // One channel's distribution at a time, the mean of all three as the density.
    float channel = 3.0 * low_discrepancy(draws.first + uint(i), draws.offset).y;
    vec2 chosen = channel < 1.0 ? vec2(rate.r, mean_way.r) : channel < 2.0 ? vec2(rate.g, mean_way.g) : vec2(rate.b, mean_way.b);
#endif
    float t = attenuated_distance(random, chosen.x, longest, chosen.y);
    Spectrum on_plane = exp(-rate * t);
    Spectrum densities = on_plane / mean_way;
#ifdef GREY
    float density = densities;
#else
    float density = (densities.r + densities.g + densities.b) / 3.0;
#endif
    Spectrum drawn = on_plane / density;
    plane += drawn;
    vec3 point = position + t * inwards;
    Entry entry = entry_above(light_map_at(frame, seen.map, point.xy * body.radius), frame, point, centre, fit.radius);
    if (entry.lit == 0.0) continue;
    float lit = entry.lit * light_reaches_tap(frame, body.radius * (point + vec3(0.0, 0.0, entry.above)));
    LightInside light = light_inside(vec3(0.0, 0.0, 1.0), entry.normal, entry.above);
    // Where the light's way in hardly grows, far samples are too rare for what they find; each may count as many, but not as any number.
    sum += lit * scattered_towards(light, inwards) * drawn * min(exp(rate * t - sigma_t * (t + light.way_in)), Spectrum(MOST_A_SAMPLE_COUNTS));
#ifdef LIGHTS_ABOUT
    if (lamp_near > 0.0) {
      light = lamp_inside(seen, entry, point, centre);
      of_lamp += lit * scattered_towards(light, inwards) * drawn * min(exp(rate * t - sigma_t * (t + light.way_in)), Spectrum(MOST_A_SAMPLE_COUNTS));
    }
#endif
  } while (++i < draws.count);
  // What the lit plane's own integral says the samples should have found.
  vec3 each = single.sigma_s * mean_way / max(plane, Spectrum(1e-30));
  return ScatteredOnce(each * sum, each * of_lamp);
}

#ifdef NEAR_LIGHTS
// What is scattered once comes in by the light's map, from one direction: what it would be by the direction of the point itself, over that.
// The first order of a thick medium is as cosine / (cosine + cosine of the view), inside; a thin one has no such slope.
Spectrum turned_to_light(BodyFit fit) {
  float facing = max(fit.facing, 1e-3);
  float turned = max(fit.cosine, 0.0) * (refracted_cosine(facing, body.eta) + fit.mu_o_refracted) /
                 (facing * (refracted_cosine(max(fit.cosine, 0.0), body.eta) + fit.mu_o_refracted + 1e-6));
  return mix(Spectrum(1.0), Spectrum(turned), fit.visible * (1.0 - exp(-SPECTRUM(single.sigma_t) * fit.radius)));
}
#endif
#endif

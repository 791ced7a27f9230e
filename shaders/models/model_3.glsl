// Model 3: the surface integral. Light that entered anywhere leaves here by a kernel over the distance (multiple scattering), and light is
// scattered once on the way that the view ray takes through the grain; both by a few samples of each light's map, drawn where they count.
// The sphere that fits the grain at the point has a known integral: the samples only tell how the grain's differs from it, so what is
// nearly a sphere is nearly without noise.
// Not physical: distances are straight through the grain, so a concave one is crossed where light would have to go round.
//
// What is chosen at compile time (physics::model_3_inputs), besides what body_light.glsl names:
//   FORWARD_PEAK         light that was scattered within the phase function's forward peak counts as unscattered
//   CROSSED              the sphere's light is also what crosses it unscattered
//   SINGLE_MARCHED       `refracted_light`: first-order scattering is not in the kernel
#include "models/body_light.glsl"
#include "models/interface.glsl"
#include "models/lamp_at_entries.glsl"
#include "models/light_map.glsl"
#include "models/pixel_random.glsl"
#include "models/portions.glsl"
#include "physics/prelude.glsl"
#include "physics/elementary.glsl"
#include "physics/fresnel.glsl"
#include "physics/henyey_greenstein.glsl"
#include "physics/tables.glsl"

#ifdef SINGLE_MARCHED
struct Single {
  vec3 sigma_s;  // per grain radius, as every length below
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
#endif

#ifdef CROSSED
uniform Spectrum crossed;  // mean free paths across the grain's sphere
#endif

struct Sampling {
  float inverse_shortest;
  float columns_per_octave;
  float largest_depth;
  float turn;
};
uniform Sampling sampling;

// Columns: distance; rows: cosine at entry. Transmittance is in it. See physics::KernelTables.
uniform sampler2D kernel;
uniform sampler2D kernel_inverse;

uniform Spectrum beyond_sphere;  // how much counts of what is gathered beyond the sphere that fits; see physics::share_beyond_sphere
uniform int taps;                // for one pixel and sample, over all lights
uniform float grain_reach;       // no point of the grain is farther than this from the origin, in scene units

// A point of the grain as a light sees it: in light space, over the grain's radius.
struct Seen {
  LightFrame frame;
  int map;
  BodyFit fit;
  vec3 position;
  vec3 fit_normal;  // of the sphere that fits
};

// Points of the low-discrepancy sequence: how many, from which on, and what turns them.
struct Draws {
  int count;
  uint first;
  uvec2 offset;
};

#ifdef SINGLE_MARCHED
vec4 at_nodes(sampler2D table, vec2 coordinate) {
  vec2 size = vec2(textureSize(table, 0));
  return texture(table, (coordinate * (size - 1.0) + 0.5) / size);
}
#endif

vec4 kernel_at(float distance, float mu) {
  vec2 size = vec2(textureSize(kernel, 0));
  float column = kernel_column(distance, sampling.inverse_shortest, sampling.columns_per_octave);
  return texture(kernel, (vec2(column, mu * (size.y - 1.0)) + 0.5) / size);
}

// Where a point at `ring` from the one under the light, in direction `azimuth` along the surface (0 is downhill), is seen from the light:
// downhill as on the tangent plane, uphill as on one that turns towards the light on the first `turn` of the way and then faces it. No convex
// surface is anywhere much nearer than `ring`, so no sample weighs much more than it should. `area`: of the projection, over that on the
// surface.
vec2 seen_from_light(float ring, float azimuth, float cosine, float turn, out float area) {
  float downhill = ring * cos(azimuth);
  float bent = clamp(-downhill, 0.0, turn);
  float faced = (1.0 - cosine) * bent / turn;
  area = cosine + faced;
  float across = downhill > 0.0 ? cosine * downhill : downhill + bent - (cosine + 0.5 * faced) * bent;
  return vec2(across, ring * sin(azimuth));
}

// Single samples that found much where little was expected would stand out as dots for thousands of frames.
const float MOST_A_SAMPLE_COUNTS = 64.0;

// How far the surface at a place is the sphere that fits, 0 or 1 or between them, for all that a light map can tell: at the terminator a texel
// is as deep as it is long, and the silhouette has corners that light would show. Else a grain whose mean free path is less than a texel
// would find its own light too far away. `from_axis`: how far the place lies from the sphere's axis along the light; `cosine`: of its normal.
float is_sphere(LightFrame frame, LightMapTexel mapped, float height, float from_axis, float radius, float cosine) {
  float texel = light_map_texel_width(frame) / body.radius;
  float apart =
      mapped.lit ? abs(height - mapped.position.z / body.radius) / (light_map_tolerance(frame, cosine) / body.radius) : (radius - from_axis) / texel;
  return 1.0 - smoothstep(1.0, 2.0, apart);
}

#ifdef LIGHTS_ABOUT
// Grains whose sphere is as large as this, over how far they reach, are balls: in those walks tell more of a lamp than diffusion does.
const float LEAST_ROUND = 0.85;
const float ROUND = 0.95;

// Samples that tell what a lamp does over what a parallel light does: a ratio of fewer is off by more than a hundredth or two.
const int LEAST_TAPS_OF_LAMP = 16;

// How much of the grain is a ball.
float ball_share() { return smoothstep(LEAST_ROUND, ROUND, body.radius / grain_reach); }

void look_about(DeviceLight lamp, vec3 middle, vec2 lamp_random, SurfacePoint point, vec3 to_middle, inout LightSample light) {
  lamp_about_index = light.index;
  lamp_about = LampAbout(lamp, lamp_random, middle, to_middle, vec3(0.0));
  lamp_near = nearness(lamp, middle, 0.0, grain_unit * grain_reach, true);
  if (ball_share() > 0.0) look_in_ball(lamp, middle, lamp_random, point, light);
}

// How much of what the light does is told by where it enters.
float by_entries(LightSample light, LightFrame frame) {
  if (light.index != lamp_about_index) lamp_near = 0.0;
  lamp_about.turned = frame.z_axis - lamp_about.to_middle;
  return lamp_near * (1.0 - ball_share());
}
#endif

struct Gathered {
  Spectrum grain;   // exitance per irradiance, by these samples
  Spectrum sphere;  // the same of the sphere that fits
  Spectrum lamp;    // of the grain, per emission of a lamp that is near
};

// Where it is known where light came in, once for all taps, none asks for itself.
float light_reaches_tap(LightFrame frame, vec3 position) { return entered >= 0.0 ? 1.0 : light_reaches_entry(frame, position); }

Gathered gather(Seen seen, Draws draws) {
  LightFrame frame = seen.frame;
  vec3 position = seen.position;
  vec3 normal = seen.fit_normal;
  // Distances are drawn as for a plane that faces the light, half as high above as the lit surface: no lit point of a sphere is nearer than
  // that plane's, so no sample weighs more than it should.
  float height = 0.5 * seen.fit.above / body.radius;

  // How the surface looks from the light: narrower by |cosine| across its tilt, and bent as on the sphere.
  float tilt = length(normal.xy);
  vec2 across = tilt > 1e-4 ? normal.xy / tilt : vec2(1.0, 0.0);
  float narrowest = max(abs(normal.z), 0.05);
  float radius = seen.fit.radius;
  vec3 centre = position - radius * normal;
  // A sphere turns within tan(angle/2) of its radius, an edge at once: light knows no difference within a few mean free paths.
  float turn = min(radius * tilt / (1.0 + narrowest), sampling.turn) + 1e-6;

  // Distances end where the grain does.
  float rim = length(position.xy) + grain_reach / body.radius;
  float widest = max(2.0 * rim, 3.0 * rim / (narrowest + sqrt(narrowest * narrowest + 2.0 * tilt * rim)));
  float depth_here = height > 0.0 ? kernel_at(height, 1.0).a : 0.0;
  float within = -expm1(depth_here - kernel_at(sqrt(height * height + widest * widest), 1.0).a);

  float last_share = float(textureSize(kernel_inverse, 0).x - 1);
  float shares = last_share * last_share / sampling.largest_depth;
  Gathered sum = Gathered(Spectrum(0.0), Spectrum(0.0), Spectrum(0.0));
  int i = 0;
  do {
    vec2 random = low_discrepancy(draws.first + uint(i), draws.offset);
    // The driver's log errs near 1, where it only moves a sample by a thousandth of its small distance.
    float depth = depth_here - log(1.0 - random.x * within);
    vec2 drawn = texelFetch(kernel_inverse, ivec2(int(sqrt(min(depth * shares, last_share * last_share)) + 0.5), 0), 0).xy;
    float ring = sqrt(max(drawn.x * drawn.x - height * height, 0.0));
    float azimuth = 2.0 * PI * random.y;
    float area;
    vec2 spread = seen_from_light(ring, azimuth, narrowest, turn, area);
    float weight = area / max(drawn.y, 1e-30);
    // Where map, mesh and shading normal disagree, lit points may seem much nearer than they were drawn: they would weigh without bounds.
    float nearest = 0.5 * drawn.x;
    vec2 place = position.xy + spread.x * across + spread.y * vec2(-across.y, across.x);

    vec2 from_axis = place - centre.xy;
    float height_squared = radius * radius - dot(from_axis, from_axis);
    LightMapTexel entry = light_map_at(frame, seen.map, place * body.radius);
    float entry_height = entry.position.z / body.radius;
    vec3 entry_normal = entry.normal;
    float lit = entry.lit ? 1.0 : 0.0;
    if (height_squared > 0.0) {
      float rise = sqrt(height_squared);
      float sphere_height = centre.z + rise;
      float apart = max(distance(vec3(place, sphere_height), position), nearest);
      sum.sphere += min(weight * SPECTRUM(kernel_at(apart, rise / radius)), Spectrum(MOST_A_SAMPLE_COUNTS));
      float same = is_sphere(frame, entry, sphere_height, length(from_axis), radius, rise / radius);
      // Farther off than this a texel's doubt is little beside the distance.
      same *= 1.0 - smoothstep(4.0, 8.0, length(spread) * body.radius / light_map_texel_width(frame));
      vec3 sphere_normal = vec3(from_axis, rise) / radius;
      entry_height = entry.lit ? mix(entry_height, sphere_height, same) : sphere_height;
      entry_normal = entry.lit ? mix(entry_normal, sphere_normal, same) : sphere_normal;
      lit = mix(lit, 1.0, same);
    }
    if (lit > 0.0) {
      float apart = max(distance(vec3(place, entry_height), position), nearest);
      lit *= light_reaches_tap(frame, body.radius * vec3(place, entry_height));
      sum.grain += lit * min(weight * SPECTRUM(kernel_at(apart, entry_normal.z)), Spectrum(MOST_A_SAMPLE_COUNTS));
#ifdef LIGHTS_ABOUT
      if (lamp_near > 0.0) {
        LampThere there = lamp_there(frame, body.radius * vec3(place, entry_height));
        Spectrum sent = SPECTRUM(kernel_at(apart, max(dot(entry_normal, there.to_lamp), 0.0)));
        sum.lamp += lit * lamp_enters(there, entry_normal) * min(weight * sent, Spectrum(MOST_A_SAMPLE_COUNTS));
      }
#endif
    }
  } while (++i < draws.count);
  float share = exp(-depth_here) * within / float(max(draws.count, 1));
  return Gathered(share * sum.grain, share * sum.sphere, share * sum.lamp);
}

// Radiance per irradiance of light scattered many times, given that of the sphere that fits.
vec3 on_the_grain(Gathered gathered, vec3 sphere, float lobe, float radius) {
  // A control variate whose weight is never above one: what is less than the sphere's scales it, what is more adds to it.
  Spectrum least = Spectrum(1e-30);
#ifdef CROSSED
  // What crosses unscattered is not gathered: that of the grain is as the sphere's.
#ifdef GREY
  least += 0.25 * mean_crossing(crossed * radius);
#else
  least += 0.25 * vec3(mean_crossing(crossed.r * radius), mean_crossing(crossed.g * radius), mean_crossing(crossed.b * radius));
#endif
#endif
  Spectrum share = min((gathered.grain + least) / (gathered.sphere + least), Spectrum(1.0));
  // A twentieth more is how samples and facets lie about the sphere, no surface that goes on beyond it.
  Spectrum more = max(gathered.grain - gathered.sphere, Spectrum(0.0));
  Spectrum about = min(more, 0.05 * gathered.sphere);
  return sphere * share + lobe * (about + beyond_sphere * (more - about));
}

#ifdef SINGLE_MARCHED
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
#endif

#if defined(NEAR_LIGHTS) && defined(SINGLE_MARCHED)
// What is scattered once comes in by the light's map, from one direction: what it would be by the direction of the point itself, over that.
// The first order of a thick medium is as cosine / (cosine + cosine of the view), inside; a thin one has no such slope.
Spectrum turned_to_light(BodyFit fit) {
  float facing = max(fit.facing, 1e-3);
  float turned = max(fit.cosine, 0.0) * (refracted_cosine(facing, body.eta) + fit.mu_o_refracted) /
                 (facing * (refracted_cosine(max(fit.cosine, 0.0), body.eta) + fit.mu_o_refracted + 1e-6));
  return mix(Spectrum(1.0), Spectrum(turned), fit.visible * (1.0 - exp(-SPECTRUM(single.sigma_t) * fit.radius)));
}
#endif

Outwards look_outwards(SurfacePoint point) { return through_surface(point); }

vec3 evaluate_model(SurfacePoint point, Outwards outwards, LightSample light) {
  LightFrame frame = light_frame(light);
#ifdef LIGHTS_ABOUT
  // What enters is told over what a parallel light does that comes along the map's axis.
  float entries_tell = by_entries(light, frame);
  vec3 own_direction = light.to_light;
  light.to_light = normalize(mix(light.to_light, frame.z_axis, entries_tell));
#endif
  BodyFit fit = fit_body(point, outwards, light, frame);
  vec3 position = to_light_space(frame, point.position) / body.radius;
  vec3 normal = to_light_space(frame, point.normal);

  int share = max(taps / max(light_count, 1), 2);
#ifdef SINGLE_MARCHED
  int single_share = max(share / 2, 1);
#else
  int single_share = 0;
#endif
  int multiple_share = share - single_share;
#ifdef LIGHTS_ABOUT
  if (entries_tell > 0.0) multiple_share = max(multiple_share, LEAST_TAPS_OF_LAMP);
#endif
  // The sequence goes on from sample to sample; only its offset differs from pixel to pixel.
  uvec4 offset = pcg4d(uvec4(uvec2(gl_FragCoord.xy), 0u, uint(light.index)));

  vec4 table = look_up_body(body_table, fit);
#ifdef PLANAR_PROFILE
  float lobe = fit.transmittance * body.even_factor;
  vec3 sphere = table.rgb * lobe;
#else
  float lobe = diffused_lobe(fit);
  Spectrum flowing = flowing_lobe(fit, point, light, flow_at(fit, table));
  LightSample unit_light = parallel_light(light.to_light, vec3(1.0), light.index, light.angle, light.map, light.density);
  vec3 sphere = corrected(fit.visible * half_space_light(point, outwards, unit_light).multiple, table.rgb, vec3(flowing));
#endif
  float tilt = sqrt(max((1.0 - fit.facing) * (1.0 + fit.facing), 0.0));
  vec3 fit_normal = vec3(normal.xy * (tilt * inversesqrt(max(dot(normal.xy, normal.xy), 1e-12))), fit.facing);
  Seen seen = Seen(frame, light.map, fit, position, fit_normal);
  Gathered gathered = gather(seen, Draws(multiple_share, uint(sample_index * multiple_share), offset.xy));
#ifdef LIGHTS_ABOUT
  light.entering = mix(light.entering, lamp_about.lamp.emission.rgb * (gathered.lamp / max(gathered.grain, Spectrum(1e-6))), entries_tell);
#endif
  vec3 radiance = portion(SUBSURFACE_PORTION, light.entering * on_the_grain(gathered, sphere, lobe, fit.radius));
#ifdef SINGLE_MARCHED
  vec3 to_viewer = to_light_space(frame, point.to_viewer);
  vec3 inwards = (fit.mu_o * normal - to_viewer) / body.eta - fit.mu_o_refracted * normal;
  ScatteredOnce once = single_scattering(seen, inwards, Draws(single_share, uint(sample_index * single_share), offset.zw));
  vec3 inside = once.parallel * light.irradiance;
#ifdef NEAR_LIGHTS
  inside *= turned_to_light(fit);
#endif
#ifdef LIGHTS_ABOUT
  inside = mix(inside, once.lamp * lamp_about.lamp.emission.rgb, lamp_near);
#endif
  radiance += portion(SINGLE_SCATTERING_PORTION, fit.transmittance / (body.eta * body.eta) * inside);
#endif
  if (entered >= 0.0) radiance *= entered;
#ifdef LIGHTS_ABOUT
  light.to_light = own_direction;
#endif
#ifdef SPECULAR
  radiance += portion(SPECULAR_PORTION, fit.visible * fit.reached * specular_reflection(point, outwards, light));
#endif
  return radiance;
}

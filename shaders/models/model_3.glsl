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
#include "models/lit_surface.glsl"
#include "models/pixel_random.glsl"
#include "models/portions.glsl"
#include "models/scattered_once.glsl"
#include "physics/prelude.glsl"
#include "physics/elementary.glsl"
#include "physics/tables.glsl"

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

struct Gathered {
  Spectrum grain;   // exitance per irradiance, by these samples
  Spectrum sphere;  // the same of the sphere that fits
  Spectrum lamp;    // of the grain, per emission of a lamp that is near
};

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
      if (lamp_entries > 0.0) {
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

Outwards look_outwards(SurfacePoint point) { return through_surface(point); }

vec3 evaluate_model(SurfacePoint point, Outwards outwards, LightSample light) {
  LightFrame frame = light_frame(light);
#ifdef LIGHTS_ABOUT
  turn_to_entries(light, frame);
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
  if (lamp_entries > 0.0) multiple_share = max(multiple_share, LEAST_TAPS_OF_LAMP);
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
  light.entering = mix(light.entering, lamp_about.lamp.emission.rgb * (gathered.lamp / max(gathered.grain, Spectrum(1e-30))), lamp_entries);
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
#ifdef SPECULAR
  radiance += portion(SPECULAR_PORTION, fit.visible * fit.reached * specular_reflection(point, outwards, light));
#endif
  return radiance;
}

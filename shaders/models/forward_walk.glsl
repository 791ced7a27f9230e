// Where a medium scatters forwards or backwards: a walk from the viewer into the grain with each sample, lit at each scattering by the light
// that nothing has scattered yet, refracted as it enters and reflected inside. Walks grow coarser by and by, and the stored source function ends
// them. The phase function's narrow peak is told apart: light that met nothing else is followed exactly; on the way of light that has also been
// scattered widely the peak counts as unscattered (Iwabuchi and Suzuki, "Fast and accurate radiance calculations using truncation
// approximation for anisotropic scattering phase functions", 2009), so that no rare walk finds as much light as thousands of others.
// The world's light is found both ways, by directions of it that are drawn for all pixels together and by where walks leave the grain, weighted by
// how likely each was to be drawn (Veach and Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering", 1995, the balance
// heuristic): the former find what is bright, the latter what a narrow phase function shows of an even sky, of which few directions tell next to
// nothing.
// Not physical: light that has left lights nothing that it enters again; where light was not followed into the grain beforehand, what the surface
// reflected inside before its first scattering comes from a sun that is some degrees wide.
//
// Pasted into transport.glsl, whose grid it reads.

struct Forward {
  vec3 sigma_s;  // the medium's own, not the similar one's; per unit of the body
  vec3 sigma_a;
  vec3 similar_albedo;
  float g;
  float one_minus_g;
  float peak_versine;  // 1 - cosine at the peak's edge
  float edge;          // the phase function there: what is more of it is the peak
  float within;        // the share of scattering by less than the peak's angle
  float peak;          // the share of it that is the peak's
  float wide_g;        // of the rest
  // Wide ones that are followed in the medium itself; from then on two of them in one medium, then two in one that scatters less often.
  int exact_scatterings;
};
uniform Forward forward;

const float LEAST_KEPT = 0.1;  // of the first direction's axis, by the mean cosine: then the stored source function tells the rest
const int MOST_STEPS = 40;
const float LEAST_FLIGHT = 1e-7;       // in mean free paths
const float LEAST_EXTINCTION = 1e-12;  // a channel of less flies through
const float LEAST_FOLLOWED = 0.25;     // of walks that meet the surface, were nothing lost: what it reflects is rare and bright
const float SUN_SHARPNESS = 50.0;      // of the lobe exp(sharpness (cosine - 1)) that reflected light comes from, at first
const float SHARPENED_BY = 16.0;       // samples: the more there are, the narrower it is, so that its width goes with the noise
                                       // (as in Knaus and Zwicker, "Progressive photon mapping: a probabilistic approach", 2011)

vec3 turned(vec3 direction, float versine, float random) {
  float sine = sqrt(versine * (2.0 - versine));
  float azimuth = 2.0 * PI * random;
  vec3 first = perpendicular(direction);
  return normalize((1.0 - versine) * direction + sine * (cos(azimuth) * first + sin(azimuth) * cross(direction, first)));
}

// By how much a scattering turns, widest first (the phase function's inverted distribution: Witt, "Multiple scattering in reflection nebulae",
// 1977, eq. 19).
float scattered_versine(float g, float one_minus_g, float random) {
  float ratio = one_minus_g * (1.0 + g) / (one_minus_g + 2.0 * g * random);
  return clamp((ratio - one_minus_g) * (ratio + one_minus_g) / (2.0 * g), 0.0, 2.0);
}

#if defined(SUMMED) && defined(REFRACTION)
#define TRACED  // light was followed into the grain beforehand, with its reflections (passes/trace_light.comp)
#endif

#ifdef TRACED
uniform usampler3D tracks;
uniform usampler3D drawn_rays;
uniform sampler3D pieces;
#ifdef TOGETHER
vec3 colour_found;
float density_found;
#endif

// Of all the light in the place's cell, some at random.
Unscattered unscattered_found(vec3 place, int light) {
  ivec3 texel = cell_texel(cell_at(place), light);
  uint count = texelFetch(tracks, texel, 0).r;
  if (count == 0u) return Unscattered(vec3(0.0, 0.0, 1.0), 0.0, 0.0);
  ivec3 piece = texel_of(texelFetch(drawn_rays, texel, 0).r);
  vec4 begin = texelFetch(pieces, piece, 0);
  vec3 direction = texelFetch(pieces, piece + ivec3(0, 0, 1), 0).xyz;
#ifdef TOGETHER
  vec4 found = texelFetch(pieces, piece + ivec3(0, 0, 2), 0);
  colour_found = found.rgb;
  density_found = found.w;
#endif
  float way = begin.w + max(dot(place - begin.xyz, direction), 0.0);
  return Unscattered(-direction, way, float(count) / TRACK_UNIT * exp(tracked_sigma_t() * way));
}
#endif

// Of the directions that a scattering sends walks in, per steradian.
float density_of_turn(float versine, float g, float one_minus_g, bool without_peak) {
  if (without_peak && versine < forward.peak_versine) return forward.edge / (1.0 - forward.peak);
  return henyey_greenstein(versine, g, one_minus_g) / (without_peak ? 1.0 - forward.peak : 1.0);
}

#ifdef WALKS_END_IN_WORLD
vec3 walked_out;  // what the last walk found of the world where it left the grain, radiance inside

// How much of what a scattering sends of the world is told by the directions drawn for all pixels, where `drawn` is their density outside and
// `turned` the walks' inside; of a sun, which no walk looks for, all.
float share_of_drawn(float drawn, float turned) { return drawn > 0.0 ? drawn / (drawn + turned / (stored.eta * stored.eta)) : 1.0; }

void leave_for_world(Spectrum left, vec3 outside, float turned, bool unmet) {
  vec3 to_world = transpose(grain_to_body()) * outside;
  float drawn = unmet ? 0.0 : drawn_density_of_world(to_world);
  float share = drawn > 0.0 ? share_of_drawn(drawn, turned) : 0.0;
  walked_out += left * ((1.0 - share) * stored.eta * stored.eta) * seen_of_world(to_world);
}
#endif

// `drawn`: the density of the directions that the light was drawn among, if it is the world's.
Radiance walked_radiance(vec3 place, vec3 direction, vec3 to_light, int light, float drawn) {
  uvec4 seed = uvec4(uvec2(gl_FragCoord.xy), uint(sample_index), uint(light));
  Radiance sum = Radiance(0.0);
  Spectrum left = Spectrum(1.0);
  float g = forward.g;
  float one_minus_g = forward.one_minus_g;
  Spectrum sigma_s = SPECTRUM(forward.sigma_s);
  Spectrum sigma_a = SPECTRUM(forward.sigma_a);
  bool narrow = true;   // the peak alone has scattered what is followed
  bool whole = true;    // the phase function is the medium's own, or that without its peak
  int scatterings = 0;  // wide ones
  bool first_place = true;
  float kept = 1.0;
  bool mirrored = false;
#ifdef WALKS_END_IN_WORLD
  walked_out = vec3(0.0);
  float turned_density = 0.0;  // of the last scattering's turn
  bool unmet = false;          // where the walk is now no light was looked for from there
#endif
  float sharpness = SUN_SHARPNESS * sqrt(1.0 + float(sample_index) / SHARPENED_BY);
  int i = 0;
  bool told = false;  // the stored source function tells the rest
  bool again_inside;
  // Software renderers follow several walks at once, each of which waits for the others wherever any of them goes: what walks come upon when they
  // meet the surface is looked for when all have, and what those that have left may enter again when all are done.
  do {
    float leaving = 0.0;  // the grain: what counts of it
#ifdef WALKS_END_IN_WORLD
    float seen_outside = 1.0;
    vec3 outside;
#endif
    bool reflected;
    do {
      bool at_surface = false;
      vec4 random;
      float flight;
      float way;
      Spectrum sigma_t = sigma_s + sigma_a;
      for (; i < MOST_STEPS; ++i) {
        random = vec4(pcg4d(seed + uvec4(0u, 0u, 0u, uint(i + 1) << 8u)) >> 8u) * (1.0 / 16777216.0);
        if (i == 0) random.xy = low_discrepancy_beside_pixel(uint(sample_index), pcg4d(uvec4(seed.xy, 5u, seed.w)).xy);
        sigma_t = sigma_s + sigma_a;
#ifdef GREY
        float flown_at = sigma_t;
#else
        // As one of the channels, drawn for each step, would fly: all count by how likely they would, together, have done so.
        random.w *= 3.0;
        float flown_at = sigma_t[int(random.w)];
        random.w = fract(random.w);
#endif
        flight = max(-log(1.0 - random.x), LEAST_FLIGHT) / max(flown_at, LEAST_EXTINCTION);
#ifdef CONVEX
        at_surface = !ends_inside(place, direction, flight);
#else
        way = way_through(place, direction, flight);
        at_surface = way < flight;
#endif
        if (at_surface) break;
        place += flight * direction;
#ifndef GREY
        vec3 passed = exp(-sigma_t * flight);
#endif
#ifdef GREY
        left *= sigma_s / sigma_t;
#else
        left *= 3.0 * sigma_s * passed / dot(sigma_t, passed);
#endif
        if (kept < LEAST_KEPT) {
          told = true;
          break;
        }
        mirrored = false;
#ifdef TRACED
        Unscattered unscattered = unscattered_found(place, light);
#elif defined(LIGHT_LINES)
        Unscattered unscattered = Unscattered(to_light, way_of_light(place, to_light, light), 1.0);
#else
        Unscattered unscattered = unscattered_at(place, to_light);
#endif
        first_place = false;
        float versine = 1.0 - dot(unscattered.back, direction);
        float phase = henyey_greenstein(versine, g, one_minus_g);
        float mean_cosine = whole && !narrow ? forward.wide_g : g;
        bool coarser = !narrow && scatterings + 1 >= forward.exact_scatterings && scatterings % 2 == 1;
        // What comes from there on is told of the medium that is similar in its first moment (van de Hulst 1980, section 14.1.3).
        if (coarser) sigma_s /= 1.0 + mean_cosine;
        float wide = whole && versine < forward.peak_versine ? forward.edge : phase;
        Spectrum wide_sigma_s = narrow ? sigma_s * (1.0 - forward.peak) : sigma_s;
        Spectrum lit = wide * exp(-(wide_sigma_s + sigma_a) * unscattered.way);
        if (narrow) {
          lit += (phase - wide) * exp(-(sigma_s + sigma_a) * unscattered.way);
        } else if (whole) {
          lit /= 1.0 - forward.peak;
        }
        bool without_peak = whole && !narrow;
#ifdef WALKS_END_IN_WORLD
#ifdef TOGETHER
        drawn = density_found;
#endif
        lit *= share_of_drawn(drawn, density_of_turn(versine, g, one_minus_g, without_peak));
#endif
#ifdef TOGETHER
        lit *= unscattered.irradiance;
        sum += left * lit * colour_found;
#else
        sum += left * (unscattered.irradiance * lit);
#endif

        float turn = scattered_versine(g, one_minus_g, random.y * (narrow || !whole ? 1.0 : 1.0 - forward.peak));
        if (narrow) {
          narrow = turn < forward.peak_versine && random.w * henyey_greenstein(turn, g, one_minus_g) >= forward.edge;
        } else if (whole && random.y * (1.0 - forward.peak) > 1.0 - forward.within) {
          turn = random.w * forward.peak_versine;
        }
#ifdef WALKS_END_IN_WORLD
        turned_density = density_of_turn(turn, g, one_minus_g, without_peak);
        unmet = false;
#endif
        direction = turned(direction, turn, random.z);
        if (narrow) continue;
        sigma_s = wide_sigma_s;
        ++scatterings;
        kept *= abs(whole ? forward.wide_g : g);
        if (coarser) {
          whole = false;
          g = mean_cosine * mean_cosine;
          one_minus_g = 1.0 - g;
        }
      }
      reflected = false;
      if (!at_surface) break;
#ifdef CONVEX
      way = way_through(place, direction, flight);
#endif
      place += way * direction;
#ifndef GREY
      vec3 passed = exp(-sigma_t * way);
      left *= 3.0 * passed / (passed.r + passed.g + passed.b);
#endif
#ifdef REFRACTION
      vec3 normal = outwards_at(place);
      float cosine = dot(normal, direction);
      float again = fresnel_reflectance(min(cosine, 1.0), 1.0 / stored.eta);
#ifdef TRACED
      float followed = again;
#else
      if (mirrored && !first_place && again < 1.0) {
        vec3 mirrored_out = refract(direction, -normal, stored.eta);
        float lobe = (1.0 - again) * stored.eta * stored.eta * sharpness / (2.0 * PI) * exp(sharpness * (dot(mirrored_out, to_light) - 1.0));
#ifdef WALKS_END_IN_WORLD
        if (drawn > 0.0) lobe = 0.0;
#endif
        sum += left * lobe;
      }
      float followed = max(again, LEAST_FOLLOWED * largest(left));
#endif
      if (cosine <= 0.0) break;
      if (random.w >= followed) {
        leaving = 1.0 / (1.0 - followed);
#ifdef WALKS_END_IN_WORLD
        seen_outside = (1.0 - again) * leaving;
        outside = refract(direction, -normal, stored.eta);
#endif
        break;
      }
      left *= again / followed;
      reflected = true;
      ++i;
      direction = direction - 2.0 * cosine * normal;
      mirrored = true;
#if defined(WALKS_END_IN_WORLD) && !defined(TRACED)
      unmet = true;
#endif
#else
      leaving = 1.0;
#ifdef WALKS_END_IN_WORLD
      outside = direction;
#endif
#endif
    } while (reflected);
    again_inside = false;
    if (leaving > 0.0) {
#ifndef CONVEX
      float beyond = comes_in_again(place, direction);
      again_inside = beyond > 0.0;
#endif
#ifdef WALKS_END_IN_WORLD
      if (!again_inside && !first_place) leave_for_world(left * seen_outside, outside, turned_density, unmet);
#endif
#ifndef CONVEX
      left *= beyond * leaving;
#ifdef REFRACTION
      mirrored = false;
#ifdef WALKS_END_IN_WORLD
      unmet = true;
#endif
#endif
      ++i;
#endif
    }
  } while (again_inside);
  if (told) sum += left * source_at(place) / SPECTRUM(forward.similar_albedo);
  return sum;
}

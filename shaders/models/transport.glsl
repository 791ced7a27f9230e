// The model `transport`: what light does inside this very mesh, found beforehand by rays in it and stored as the source function at nodes of a
// grid, for light from anywhere. The view ray is followed through the grain, and once more from where it is reflected inside.
// Not physical: where light is walked a rough surface is smooth from inside; scattering is isotropic, by similarity, but where it is walked.
//
// What is chosen at compile time (models::transport_inputs), besides what dielectric.glsl names:
//   CLEAR                so much crosses the grain unscattered that it is seen
//   WALKED               light scatters forwards or backwards: what similarity does not tell is found by walks
//   FACETS               the surface is rough: each sample looks through one of its facets
//   CONVEX               no line leaves the grain and enters it again
//   HOLLOW               much of what leaves it enters it again
//   MANY_TERMS           more products than the fewest: the grain is not of the thickest
//   MORE_TERMS           more of them still: it is thick, and not of the thickest, and WALKED and GREY
//   MOST_TERMS           most of them: it is as thick, and not WALKED
//   GREY                 red, green and blue are the same medium, of which one is stored
//   SUMMED               the products were summed for each light beforehand (passes/sum_products.comp), and where light is refracted and walked,
//                        light was followed into the grain (passes/trace_light.comp)
//   LIGHT_LINES          so it was where light goes straight (passes/cut_light_lines.comp)
//   STORED_LIGHTS        of some lights it is stored what each does in the grain (models/stored_lights.glsl)
//   TOGETHER             and for all lights together, nothing standing in their way
//   WALKS_END_IN_WORLD   light is walked, there is a world, and nothing but the grain may stand before it: walks that leave it find it
#include "heap/open_beyond.glsl"
#include "models/dielectric.glsl"
#include "models/interface.glsl"
#include "models/lamp_in_grain.glsl"
#include "models/light_lines.glsl"
#include "models/light_tracks.glsl"
#include "models/pixel_random.glsl"
#include "models/portions.glsl"
#include "models/stored_grid.glsl"
#include "models/stored_lights.glsl"
#include "models/stored_products.glsl"
#include "models/unscattered.glsl"
#include "physics/prelude.glsl"
#include "physics/elementary.glsl"
#include "physics/fresnel.glsl"
#include "physics/ggx.glsl"
#include "physics/henyey_greenstein.glsl"
#include "scene/world.glsl"

// What the source function is told in: all lights together have colours.
#ifdef TOGETHER
#define Radiance vec3
#else
#define Radiance Spectrum
#endif

#ifdef WALKS_END_IN_WORLD
uniform int world_directions;  // so many of a sample's lights are the world's
#endif

vec3 looked_up;  // the direction towards the light whose source function is told
int looked_up_light;
#ifdef SUMMED
uniform sampler3D summed;  // the source function of each light, blocks of nodes behind one another

#else
vec4 lobe[LOBE_TEXELS];
#endif

void look_up(vec3 to_light, int light) {
  looked_up = to_light;
  looked_up_light = light;
#ifdef STORED_LIGHTS
  if (light_block >= 0) return;
#endif
#ifndef SUMMED
  for (int i = 0; i < LOBE_TEXELS; ++i) lobe[i] = lobe_texel(to_light, i);
#endif
}

#ifndef SUMMED
// At a texel's middle of `size`.
Spectrum products_at(vec3 node, vec3 size) {
#ifdef STORED_LIGHTS
  if (light_block >= 0)
    return SPECTRUM(texture(light_sources, vec3(node.xy, node.z + float(light_block) * size.z) / vec3(textureSize(light_sources, 0))));
#endif
  vec3 scale = 1.0 / vec3(size.xy, size.z * float(TERM_TEXELS));
  Spectrum sum = Spectrum(0.0);
  for (int i = 0; i < TERM_TEXELS; ++i) {
    vec4 terms = texture(sources, vec3(node.xy, node.z + float(i) * size.z) * scale);
#ifdef GREY
    sum += dot(terms, lobe[i]);
#else
    sum += vec3(dot(terms, lobe[i]), dot(terms, lobe[TERM_TEXELS + i]), dot(terms, lobe[2 * TERM_TEXELS + i]));
#endif
  }
  return sum;
}
#endif

#ifndef REFRACTION
// What a light of irradiance 1 does that goes straight to a place.
Spectrum scattered_first(vec3 place, vec3 to_light, int light) {
#ifdef LIGHT_LINES
  float way = way_of_light(place, to_light, light);
#else
  float way = way_of_light(place, to_light);
#endif
  return SPECTRUM(stored.albedo) / (4.0 * PI) * exp(-SPECTRUM(stored.sigma_t) * way);
}
#endif

// Radiance that a mean free path of the medium adds, per irradiance of the light that was looked up; TOGETHER: of all.
Radiance source_at(vec3 place) {
  vec3 size = stored.last_node + 1.0;
  vec3 node = to_nodes(place) + 0.5;
#ifdef TOGETHER
  Radiance sum = texture(summed, node / size).rgb;
#elif defined(SUMMED)
  Spectrum sum = SPECTRUM(texture(summed, vec3(node.xy, node.z + float(looked_up_light) * size.z) / vec3(textureSize(summed, 0))));
#else
  Spectrum sum = products_at(node, size);
#endif
  sum = max(sum, Radiance(0.0));
#ifndef REFRACTION
  float depth = max(-distance_at(place), 0.0);
#ifdef GREY
  sum *= scattered_share_below(stored.sigma_t.r * depth);
#else
  sum *= vec3(scattered_share_below(stored.sigma_t.r * depth), scattered_share_below(stored.sigma_t.g * depth),
              scattered_share_below(stored.sigma_t.b * depth));
#endif
#ifdef LAMP_IN_GRAIN
  if (light_about == looked_up_light) return about.parallel * sum + lamp_scattered_once(place);
#endif
    // Light that nothing has scattered comes straight. Its shadows are too sharp for few products: they would be blotches.
#ifdef TOGETHER
  int i = 0;
  do {
    sum += lights[i].irradiance.rgb * scattered_first(place, grain_to_body() * lights[i].to_light.xyz, i);
  } while (++i < light_count);
#else
  sum += scattered_first(place, looked_up, looked_up_light);
#endif
#endif
  return sum;
}

#ifdef GREY
const int FIRST_TAPS = 6;
const int FURTHER_TAPS = 3;

// Where in [0, 1] a polynomial is asked for, and for how much that counts in its mean (Abramowitz & Stegun, table 25.4, n = 6 and 3).
const vec2 SIX_PLACES[] = vec2[](vec2(0.0337652429, 0.0856622462), vec2(0.1693953068, 0.1803807865), vec2(0.3806904070, 0.2339569673),
                                 vec2(0.6193095930, 0.2339569673), vec2(0.8306046932, 0.1803807865), vec2(0.9662347571, 0.0856622462));
const vec2 THREE_PLACES[] = vec2[](vec2(0.1127016654, 0.2777777778), vec2(0.5, 0.4444444444), vec2(0.8872983346, 0.2777777778));

// What is sent towards the beginning of a piece of a way through the grain: the integral of the source times exp(-t), t the mean free paths to it.
// In s = 1 - exp(-t / 2) that is one of the source times 2 (1 - s), and a source that grows or falls off with the depth as light does, by up to
// exp(t / 2) and however fast, is about a polynomial there: from behind a thick grain most of what is seen comes from deep below.
Radiance march(vec3 place, vec3 direction, float way, int taps) {
  float sigma_t = stored.sigma_t.r;
  float thickness = sigma_t * way;
  bool thin = thickness < 1e-3;
  float within = thin ? 0.5 * thickness : 1.0 - exp(-0.5 * thickness);
  Radiance radiance = Radiance(0.0);
  for (int i = 0; i < taps; ++i) {
    vec2 asked = taps == FIRST_TAPS ? SIX_PLACES[i] : THREE_PLACES[i];
    float left = 1.0 - asked.x * within;
    float at = thin ? asked.x * way : -2.0 * log(left) / sigma_t;
    radiance += 2.0 * asked.y * within * left * source_at(place + at * direction);
  }
  return radiance;
}
#else
#ifdef REFRACTION
const int FIRST_TAPS = 8;
#else
const int FIRST_TAPS = 10;
#endif
const int FURTHER_TAPS = 3;

// The same for three channels, which see unlike depths: intervals in each of which, in the mean of the channels, as large a share of what they see
// is scattered; within each the source is a constant and what grows as light from beyond does.
vec3 march(vec3 place, vec3 direction, float way, int taps) {
  vec3 sigma_t = stored.sigma_t;
  float whole = max(way, 1e-6);
  vec3 rates = max(sigma_t, vec3(1e-3 / whole));
  vec3 shares = 1.0 / (3.0 * (1.0 - exp(-rates * whole)));
  vec3 radiance = vec3(0.0);
  vec3 passed = vec3(1.0);
  vec3 before = source_at(place);
  float from = 0.0;
  for (int i = 1; i <= taps; ++i) {
    // The share grows ever more slowly: steps of Newton's method do not go too far.
    float until = from;
    for (int turn = 0; turn < 2; ++turn) {
      vec3 beyond = exp(-rates * until);
      until += max(float(i) / float(taps) - dot(shares, 1.0 - beyond), 0.0) / dot(shares, rates * beyond);
    }
    until = i == taps ? way : min(until, way);
    vec3 source = source_at(place + until * direction);
    vec3 thickness = sigma_t * (until - from);
    vec3 left = exp(-thickness);
    // What the source at the interval's end counts.
    vec3 late = mix((thickness - 1.0 + left) * left / max(1.0 - left, vec3(1e-6)), thickness * (0.5 - thickness * (5.0 / 12.0 - thickness / 6.0)),
                    lessThan(thickness, vec3(0.05)));
    radiance += passed * ((1.0 - left - late) * before + late * source);
    passed *= left;
    before = source;
    from = until;
  }
  return radiance;
}
#endif

// What leaves the grain is followed until so little of it is left.
const float LEAST_PASSED = 0.004;
const float LEAST_FOLLOWED_ON = 0.02;
const float HALF_SCATTERED = 0.693;  // mean free paths
#ifdef CLEAR
const int MOST_WAYS = 6;
#else
const int MOST_WAYS = 4;
#endif
// What is inside still, after as many ways, is reflected no more than light that goes every way is: whatever has come in through facets finds
// one to leave by, though it be reflected wholly a few times.
const float MOST_AGAIN = 0.6;

float later_again(float again) { return min(again, MOST_AGAIN); }

#ifdef REFRACTION
// Where the view ray meets the surface from inside, for the i-th time; drawn anew with each sample if it is made of facets.
vec3 facet_outwards(vec3 place, vec3 direction, int i) {
  vec3 normal = outwards_at(place);
#ifdef FACETS
  if (dot(normal, direction) <= 0.0) return normal;
  vec4 random = vec4(pcg4d(uvec4(uvec2(gl_FragCoord.xy), 6u + uint(i), uint(sample_index))) >> 8u) * (1.0 / 16777216.0);
  // Seen from inside they lie upside down, and are as likely.
  return ggx_visible_facet(normal, direction, surface.roughness, random.xy);
#else
  return normal;
#endif
}

// How much of it stays inside.
float kept_inside(vec3 place, vec3 direction, vec3 facet) {
  float cosine = clamp(dot(facet, direction), 0.0, 1.0);
#ifdef FACETS
  float mu_beyond = dot(outwards_at(place), refract(direction, -facet, stored.eta));
  return dielectric_facet_kept(cosine, mu_beyond, stored.eta, surface.roughness);
#else
  return fresnel_reflectance(cosine, 1.0 / stored.eta);
#endif
}

// Where it goes on.
vec3 reflected_inwards(vec3 place, vec3 direction, vec3 facet) {
#ifdef FACETS
  return reflected_by_facet(outwards_at(place), facet, direction);
#else
  return direction - 2.0 * dot(facet, direction) * facet;
#endif
}
#endif

#ifndef CONVEX
// How much of the radiance that goes out at a place, of a ray from the viewer, is some that came out of the grain elsewhere; the ray goes on there.
float comes_in_again(inout vec3 place, inout vec3 direction) {
#ifdef REFRACTION
  vec3 normal = outwards_at(place);
  float cosine = dot(normal, direction);
  if (cosine <= 0.0) return 0.0;
  float passed = 1.0 - fresnel_reflectance(min(cosine, 1.0), 1.0 / stored.eta);
  if (passed <= 0.0) return 0.0;
  direction = refract(direction, -normal, stored.eta);
  float gap = way_to_next_entry(place, direction);
  if (gap < 0.0) return 0.0;
  place += gap * direction;
  normal = outwards_at(place);
  cosine = -dot(normal, direction);
  if (cosine <= 0.0) return 0.0;
  direction = refract(direction, normal, 1.0 / stored.eta);
  return passed * (1.0 - fresnel_reflectance(min(cosine, 1.0), stored.eta));
#else
  float gap = way_to_next_entry(place, direction);
  if (gap < 0.0) return 0.0;
  place += gap * direction;
  return 1.0;
#endif
}
#endif

#ifndef WALKED
#ifndef CONVEX
const int WAYS_IN_NEXT = 2;  // after the view ray has left the grain and entered it again
#endif

#ifdef REFRACTION
// What a ray meets on a way through the grain that is so long, and after reflections inside.
Radiance radiance_reflected(vec3 place, vec3 direction, float way, Spectrum left, int ways, int taps) {
  Radiance sum = Radiance(0.0);
  for (int i = 0; i < ways; ++i) {
    if (i > 0) way = way_through(place, direction, FAR);
    sum += left * march(place, direction, way, i == 0 ? taps : FURTHER_TAPS);
    Spectrum passed = exp(-SPECTRUM(stored.sigma_t) * way);
    place += way * direction;
    vec3 facet = facet_outwards(place, direction, i);
    float again = dot(facet, direction) > 0.0 ? kept_inside(place, direction, facet) : 0.0;
    left *= passed * again;
    if (largest(left) < LEAST_PASSED) break;
    direction = reflected_inwards(place, direction, facet);
    if (largest(left) < LEAST_FOLLOWED_ON || i + 1 == ways) {
      // From there on as if every way were like that one, and the source as it is where half of the light that comes back is scattered.
      vec3 halfway = place + min(0.5 * way, HALF_SCATTERED / largest(SPECTRUM(stored.sigma_t))) * direction;
      sum += left * (1.0 - passed) / (1.0 - later_again(again) * passed) * source_at(halfway);
      break;
    }
  }
  return sum;
}

// Along the view ray.
Radiance radiance_inside(vec3 place, vec3 direction) {
  float way = way_through(place, direction, FAR);
  Radiance sum = radiance_reflected(place, direction, way, Spectrum(1.0), MOST_WAYS, FIRST_TAPS);
#ifndef CONVEX
  Spectrum left = exp(-SPECTRUM(stored.sigma_t) * way);
  place += way * direction;
  if (largest(left) > LEAST_PASSED) left *= comes_in_again(place, direction);
  if (largest(left) > LEAST_PASSED) sum += radiance_reflected(place, direction, way_through(place, direction, FAR), left, WAYS_IN_NEXT, FURTHER_TAPS);
#endif
  return sum;
}
#else
// Along the view ray, which goes straight on beyond what it leaves.
Radiance radiance_inside(vec3 place, vec3 direction) {
  Radiance sum = Radiance(0.0);
  Spectrum left = Spectrum(1.0);
  for (int i = 0; i < MOST_WAYS; ++i) {
    float way = way_through(place, direction, FAR);
    sum += left * march(place, direction, way, i == 0 ? FIRST_TAPS : FURTHER_TAPS);
#ifdef CONVEX
    break;
#else
    left *= exp(-SPECTRUM(stored.sigma_t) * way);
    place += way * direction;
    if (largest(left) < LEAST_PASSED || comes_in_again(place, direction) == 0.0) break;
#endif
  }
  return sum;
}
#endif
#endif

#ifdef WALKED
#include "models/forward_walk.glsl"
#endif

// Where the view ray is inside, and where it goes on to.
vec3 place_below;
vec3 direction_below;

#ifdef FACETS
// Through one of the facets that the viewer sees. What it does not reflect, or reflects to another, goes on inside: as specular_reflection has it.
// Returns how much that is.
float look_through_facet(SurfacePoint point, float mu, out vec3 inwards) {
#ifdef WALKED
  vec2 random = vec2(pcg4d(uvec4(uvec2(gl_FragCoord.xy), 5u, uint(sample_index))).xy >> 8u) * (1.0 / 16777216.0);
#else
  vec2 random = low_discrepancy_beside_pixel(uint(sample_index), pcg4d(uvec4(uvec2(gl_FragCoord.xy), 5u, 0u)).xy);
#endif
  vec3 facet = ggx_visible_facet(point.normal, point.to_viewer, surface.roughness, random);
  float cosine = clamp(dot(facet, point.to_viewer), 0.0, 1.0);
  inwards = refracted_by_facet(point.normal, facet, point.to_viewer, cosine, stored.eta);
#ifdef MASKING_SEPARABLE
  const bool correlated = false;
#else
  const bool correlated = true;
#endif
  float mu_mirrored = dot(point.normal, 2.0 * cosine * facet - point.to_viewer);
  return dielectric_facet_passed(cosine, mu_mirrored, mu, stored.eta, surface.roughness, correlated);
}
#endif

Outwards look_outwards(SurfacePoint point) {
  mat3 to_body = grain_to_body();
  place_below = to_body * point.on_triangle * stored.units;
#ifdef FACETS
  float mu = clamp(dot(point.normal, point.to_viewer), 0.0, 1.0);
  vec3 inwards;
  float passed = look_through_facet(point, mu, inwards);
  Outwards outwards = Outwards(mu, clamp(-dot(inwards, point.normal), 0.0, 1.0), passed);
#else
  Outwards outwards = through_surface(point);
  vec3 inwards = (outwards.mu * point.normal - point.to_viewer) / stored.eta - outwards.mu_refracted * point.normal;
#endif
  direction_below = normalize(to_body * inwards);
  return outwards;
}

// What comes out of radiance that is on its way to the viewer inside.
vec3 comes_out(Outwards outwards, vec3 inside) { return portion(SUBSURFACE_PORTION, outwards.transmittance / (stored.eta * stored.eta) * inside); }

#ifdef TOGETHER
vec3 together_lit(SurfacePoint point, Outwards outwards) {
#ifdef WALKED
  Radiance inside = walked_radiance(place_below, direction_below, vec3(0.0), 0, 0.0);
#ifdef WALKS_END_IN_WORLD
  inside += walked_out;
#endif
  return comes_out(outwards, inside);
#else
  return comes_out(outwards, radiance_inside(place_below, direction_below));
#endif
}
#endif

vec3 evaluate_model(SurfacePoint point, Outwards outwards, LightSample light) {
  vec3 radiance = vec3(0.0);
#ifndef TOGETHER
  vec3 to_light = grain_to_body() * light.entering_from;
  look_up(to_light, light.index);
#ifdef WALKED
  Spectrum inside = walked_radiance(place_below, direction_below, to_light, light.index, light.density);
#else
  Spectrum inside = radiance_inside(place_below, direction_below);
#endif
  radiance = comes_out(outwards, light.entering * inside);
#ifdef WALKS_END_IN_WORLD
  if (light.density > 0.0) radiance += comes_out(outwards, walked_out / float(world_directions));
#endif
#endif
#ifdef SPECULAR
  radiance += portion(SPECULAR_PORTION, specular_reflection(point, outwards, light));
#endif
  return radiance;
}

#if defined(CLEAR) && (defined(WORLD) || defined(GATHERED))
// What is refracted out of the grain after each reflection inside; the last stands for all that follow. Lengths are too short to tell the world
// from elsewhere.
vec3 crossing_light(SurfacePoint point, Outwards outwards) {
  mat3 to_world = transpose(grain_to_body());
  vec3 place = place_below;
  vec3 direction = direction_below;
  vec3 left = vec3(open_beyond(point.normal, point.to_viewer) * outwards.transmittance);
  vec3 sum = vec3(0.0);
#ifdef WALKED
  vec3 sigma_t = vec3(forward.sigma_s);
  vec3 sigma_a = forward.sigma_a;
#else
  vec3 sigma_t = stored.sigma_t * stored.albedo;
  vec3 sigma_a = stored.sigma_t - sigma_t;
#endif
  // A look through the grain's own facets is absorbed on its own way.
  if (!looked_through()) sigma_t += sigma_a;
  for (int i = 0; i < MOST_WAYS; ++i) {
    float way = way_through(place, direction, FAR);
    vec3 passed = exp(-sigma_t * way);
    left *= passed;
    place += way * direction;
#ifdef REFRACTION
    vec3 normal = facet_outwards(place, direction, i);
    float cosine = clamp(dot(normal, direction), 0.0, 1.0);
    float again = kept_inside(place, direction, normal);
    float sine_squared = stored.eta * stored.eta * (1.0 - cosine) * (1.0 + cosine);
    vec3 outside = normalize(stored.eta * (direction - cosine * normal) + sqrt(max(1.0 - sine_squared, 0.0)) * normal);
    bool last = i + 1 == MOST_WAYS || max(left.r, max(left.g, left.b)) * again < LEAST_PASSED;
    // What is left after as many ways as radiance_inside follows goes on as it has it; what is scattered there is told there.
    float later = later_again(again);
    vec3 leaves = 1.0 - again + (last ? again * (1.0 - later) * passed / (1.0 - later * passed) : vec3(0.0));
    sum += left * leaves * seen_behind(to_world * outside);
    if (last) break;
    left *= again;
    direction = reflected_inwards(place, direction, normal);
#else
#ifndef CONVEX
    if (i + 1 < MOST_WAYS && comes_in_again(place, direction) > 0.0) continue;
#endif
    sum += seen_straight_on(left, to_world * direction);
    break;
#endif
  }
  return sum;
}
#endif

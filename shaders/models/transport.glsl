// The model `transport`: what light does inside this very mesh, found beforehand by rays in it and stored as the source function at nodes of a
// grid, for light from anywhere. The view ray is followed through the grain, and once more from where it is reflected inside.
// Not physical: a rough surface is smooth from inside; scattered light that has left does not come back; scattering is isotropic, by similarity,
// but where it is walked.
//
// What is chosen at compile time (models::transport_inputs), besides what dielectric.glsl names:
//   CLEAR                so much crosses the grain unscattered that it is seen
//   WALKED               light scatters forwards: what similarity does not tell is found by walks
//   CONVEX               no line leaves the grain and enters it again
//   MANY_TERMS           more of them: the grain is not of the thickest
//   GREY                 red, green and blue are the same medium: a texel of `sources` holds four terms, else one in three colours
//   SUMMED               the products were summed for each light beforehand (passes/sum_products.comp)
#include "heap/open_beyond.glsl"
#include "models/dielectric.glsl"
#include "models/interface.glsl"
#include "models/pixel_random.glsl"
#include "models/portions.glsl"
#include "models/stored_products.glsl"
#include "physics/prelude.glsl"
#include "physics/elementary.glsl"
#include "physics/fresnel.glsl"
#include "physics/henyey_greenstein.glsl"
#include "scene/world.glsl"

vec3 to_nodes(vec3 place) { return clamp((place - stored.lower) * stored.nodes_a_unit, vec3(0.0), stored.last_node); }

float distance_at(vec3 place) { return texture(distances, (to_nodes(place) + 0.5) / (stored.last_node + 1.0)).r; }

vec3 outwards_at(vec3 place) {
  vec3 step = 0.5 / stored.nodes_a_unit;
  vec3 gradient = vec3(distance_at(place + vec3(step.x, 0.0, 0.0)) - distance_at(place - vec3(step.x, 0.0, 0.0)),
                       distance_at(place + vec3(0.0, step.y, 0.0)) - distance_at(place - vec3(0.0, step.y, 0.0)),
                       distance_at(place + vec3(0.0, 0.0, step.z)) - distance_at(place - vec3(0.0, 0.0, step.z))) /
                  step;
  return gradient * inversesqrt(max(dot(gradient, gradient), 1e-12));
}

// How far it is to the side of the body's box that a line inside it leaves through.
float way_to_box(vec3 place, vec3 direction) {
  vec3 upper = stored.lower + stored.last_node / stored.nodes_a_unit;
  vec3 steep =
      vec3(abs(direction.x) > 1e-6 ? direction.x : 1e-6, abs(direction.y) > 1e-6 ? direction.y : 1e-6, abs(direction.z) > 1e-6 ? direction.z : 1e-6);
  vec3 ways = max((stored.lower - place) / steep, (upper - place) / steep);
  return max(min(ways.x, min(ways.y, ways.z)), 0.0);
}

#ifndef REFRACTION
const int MOST_STEPS_ASIDE = 32;

// How much of the straight line to a light is inside the grain, which it may leave and enter again.
float way_of_light(vec3 place, vec3 to_light) {
  float furthest = way_to_box(place, to_light);
  vec3 spacing = 1.0 / stored.nodes_a_unit;
  float shortest = 0.3 * min(spacing.x, min(spacing.y, spacing.z));
  float before = distance_at(place);
  float way = 0.0;
  float inside = 0.0;
  for (int i = 0; i < MOST_STEPS_ASIDE && way < furthest; ++i) {
    float step = min(max(abs(before), shortest), furthest - way);
    way += step;
    float after = distance_at(place + way * to_light);
    float below = max(-before, 0.0) + max(-after, 0.0);
    inside += step * below / max(abs(before) + abs(after), 1e-9);
#ifdef CONVEX
    if (after > 0.0) break;
#endif
    before = after;
  }
  return inside;
}
#endif

vec3 looked_up;  // the direction towards the light whose source function is told
#ifdef SUMMED
uniform sampler3D summed;  // the source function of each light, blocks of nodes behind one another
int looked_up_light;
#else
vec4 lobe[LOBE_TEXELS];
#endif

void look_up(vec3 to_light, int light) {
  looked_up = to_light;
#ifdef SUMMED
  looked_up_light = light;
#else
  for (int i = 0; i < LOBE_TEXELS; ++i) lobe[i] = lobe_texel(to_light, i);
#endif
}

// Radiance that a mean free path of the medium adds, per irradiance of the light that was looked up.
Spectrum source_at(vec3 place) {
  vec3 size = stored.last_node + 1.0;
  vec3 node = to_nodes(place) + 0.5;
#ifdef SUMMED
  Spectrum sum = SPECTRUM(texture(summed, vec3(node.xy, node.z + float(looked_up_light) * size.z) / vec3(textureSize(summed, 0))));
#else
  vec3 scale = 1.0 / vec3(size.xy, size.z * float(LOBE_TEXELS));
  Spectrum sum = Spectrum(0.0);
  for (int block = 0; block < LOBE_TEXELS; ++block) {
    vec4 texel = texture(sources, vec3(node.xy, node.z + float(block) * size.z) * scale);
#ifdef GREY
    sum += dot(texel, lobe[block]);
#else
    sum += texel.rgb * lobe[block].rgb;
#endif
  }
#endif
  sum = max(sum, Spectrum(0.0));
#ifndef REFRACTION
  float depth = max(-distance_at(place), 0.0);
#ifdef GREY
  sum *= scattered_share_below(stored.sigma_t.r * depth);
#else
  sum *= vec3(scattered_share_below(stored.sigma_t.r * depth), scattered_share_below(stored.sigma_t.g * depth),
              scattered_share_below(stored.sigma_t.b * depth));
#endif
  // Light that nothing has scattered comes straight. Its shadows are too sharp for few products: they would be blotches.
  sum += SPECTRUM(stored.albedo) / (4.0 * PI) * exp(-SPECTRUM(stored.sigma_t) * way_of_light(place, looked_up));
#endif
  return sum;
}

const float FAR = 1e6;

// How far it is through the grain, or `longest` if that is less, by steps as long as the surface is away.
float way_through(vec3 place, vec3 direction, float longest) {
  float furthest = min(way_to_box(place, direction), longest);  // beyond the box the grid tells nothing
#if defined(WALKED) && defined(CONVEX)
  // What begins and ends inside has not left.
  if (furthest == longest && distance_at(place + longest * direction) < 0.0) return longest;
#endif
  vec3 spacing = 1.0 / stored.nodes_a_unit;
  float shortest = 0.3 * min(spacing.x, min(spacing.y, spacing.z));
  float way = shortest;
  float before = 0.0;
  float below = 0.0;
  for (int i = 0; i < 48; ++i) {
    if (way >= furthest) return furthest;
    float above = distance_at(place + way * direction);
    // The first step may not have got below the surface yet, where the grid rounds an edge off.
    if (above >= 0.0 && i > 0) return mix(before, way, below / max(below + above, 1e-6));
    below = max(-above, 0.0);
    before = way;
    way += max(below, shortest);
  }
  return way;
}

struct Marched {
  Spectrum radiance;
  Spectrum passed;  // the share of light that comes through from the other end
};

// What is sent towards the beginning of a way through the grain.
Marched march(vec3 place, vec3 direction, float way, int taps) {
  Spectrum sigma_t = SPECTRUM(stored.sigma_t);
  float mean_sigma_t = (stored.sigma_t.r + stored.sigma_t.g + stored.sigma_t.b) / 3.0;
  float thickness = mean_sigma_t * way;
  float within = thickness > 1e-3 ? 1.0 - exp(-thickness) : thickness;
  Marched marched = Marched(Spectrum(0.0), Spectrum(1.0));
  for (int i = 0; i < taps; ++i) {
    // Intervals in each of which as much is scattered.
    float middle = (float(i) + 0.5) / float(taps);
    float end = (float(i) + 1.0) / float(taps);
    float at = thickness > 1e-3 ? -log(1.0 - middle * within) / mean_sigma_t : middle * way;
    float until = i + 1 == taps ? way : thickness > 1e-3 ? -log(1.0 - end * within) / mean_sigma_t : end * way;
    Spectrum left = exp(-sigma_t * until);
    marched.radiance += (marched.passed - left) * source_at(place + at * direction);
    marched.passed = left;
  }
  return marched;
}

float largest(Spectrum value) {
#ifdef GREY
  return value;
#else
  return max(value.r, max(value.g, value.b));
#endif
}

// What leaves the grain is followed until so little of it is left.
const float LEAST_PASSED = 0.004;
#ifdef CLEAR
const int MOST_WAYS = 6;
#else
const int MOST_WAYS = 4;
#endif
// Light that is reflected wholly for ever, where nothing is scattered, is told as if so little of it left.
const float TRAPPED = 1e-6;

Spectrum radiance_inside(vec3 place, vec3 direction) {
  Spectrum sum = Spectrum(0.0);
  Spectrum left = Spectrum(1.0);
  for (int i = 0; i < MOST_WAYS; ++i) {
    float way = way_through(place, direction, FAR);
    Marched marched = march(place, direction, way, i == 0 ? 6 : 3);
    sum += left * marched.radiance;
#ifdef REFRACTION
    place += way * direction;
    vec3 normal = outwards_at(place);
    float cosine = dot(normal, direction);
    float again = cosine > 0.0 ? fresnel_reflectance(min(cosine, 1.0), 1.0 / stored.eta) : 0.0;
    left *= marched.passed * again;
    if (largest(left) < LEAST_PASSED) break;
    // From there on as if every way were like this one and the source as it is there.
    if (i + 1 == MOST_WAYS) sum += left * source_at(place) * (1.0 - marched.passed) / (1.0 - again * marched.passed + TRAPPED);
    direction = direction - 2.0 * cosine * normal;
#else
    break;
#endif
  }
  return sum;
}

#ifdef WALKED
#include "models/forward_walk.glsl"
#endif

vec3 evaluate_model(SurfacePoint point, Outwards outwards, LightSample light) {
  mat3 to_body = grain_to_body();
  look_up(to_body * light.to_light, light.index);
  vec3 inwards = (outwards.mu * point.normal - point.to_viewer) / stored.eta - outwards.mu_refracted * point.normal;
#ifdef WALKED
  Spectrum inside = walked_radiance(to_body * point.on_triangle * stored.units, normalize(to_body * inwards), to_body * light.to_light, light.index);
#else
  Spectrum inside = radiance_inside(to_body * point.on_triangle * stored.units, normalize(to_body * inwards));
#endif
  vec3 radiance = portion(SUBSURFACE_PORTION, light.entering * (outwards.transmittance / (stored.eta * stored.eta) * inside));
#ifdef SPECULAR
  radiance += portion(SPECULAR_PORTION, specular_reflection(point, outwards, light));
#endif
  return radiance;
}

#if defined(CLEAR) && defined(WORLD)
// What is refracted out of the grain after each reflection inside; the last stands for all that follow. Lengths are too short to tell the world
// from elsewhere.
vec3 crossing_light(SurfacePoint point, Outwards outwards) {
  mat3 to_body = grain_to_body();
  mat3 to_world = transpose(to_body);
  vec3 inwards = (outwards.mu * point.normal - point.to_viewer) / stored.eta - outwards.mu_refracted * point.normal;
  vec3 place = to_body * point.on_triangle * stored.units;
  vec3 direction = normalize(to_body * inwards);
  vec3 left = vec3(open_beyond(point.normal, point.to_viewer) * outwards.transmittance);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < MOST_WAYS; ++i) {
    float way = way_through(place, direction, FAR);
#ifdef WALKED
    vec3 passed = exp(-(forward.sigma_s + forward.sigma_a) * way);
#else
    vec3 passed = exp(-stored.sigma_t * way);
#endif
    left *= passed;
    place += way * direction;
    vec3 normal = outwards_at(place);
    float cosine = clamp(dot(normal, direction), 0.0, 1.0);
#ifdef REFRACTION
    float again = fresnel_reflectance(cosine, 1.0 / stored.eta);
    float sine_squared = stored.eta * stored.eta * (1.0 - cosine) * (1.0 + cosine);
    vec3 outside = normalize(stored.eta * (direction - cosine * normal) + sqrt(max(1.0 - sine_squared, 0.0)) * normal);
    bool last = i + 1 == MOST_WAYS || max(left.r, max(left.g, left.b)) * again < LEAST_PASSED;
    // What is left after as many ways as radiance_inside follows goes on as if every way were like this one; what is scattered there is told there.
    vec3 leaves = last ? (1.0 - again + TRAPPED) / (1.0 - again * passed + TRAPPED) : vec3(1.0 - again);
    sum += left * leaves * seen_of_world(to_world * outside);
    if (last) break;
    left *= again;
    direction = direction - 2.0 * cosine * normal;
#else
    sum += left * seen_of_world(to_world * direction);
    break;
#endif
  }
  return sum;
}
#endif

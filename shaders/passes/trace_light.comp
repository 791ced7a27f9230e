// Follows rays of each of a sample's suns through a prototype, refracted and reflected, and leaves in the cells that they pass how much light they
// are and which way it goes: however many ways light comes in by, and reflected wholly or not, all of it is there.
// Not physical: light that has left does not come back.
//
// What is chosen at compile time: as in models/light_tracks.glsl.
#include "render/bindings.glsl"
#include "render/distant_light.glsl"
#include "models/directions.glsl"
#include "models/light_tracks.glsl"
#include "physics/prelude.glsl"
#include "physics/fresnel.glsl"

const int GROUP = 64;  // rays of one light
layout(local_size_x = GROUP) in;

layout(std430, binding = DISTANT_LIGHTS_BINDING) readonly buffer Lights { DistantLight lights[]; };

layout(r32ui, binding = 0) uniform uimage3D tracks;
layout(r32ui, binding = 1) uniform uimage3D drawn_rays;
layout(rgba32f, binding = 2) writeonly uniform image3D pieces;

const float LEAST_FLUX = 0.002;  // of what the ray was outside
const int MOST_TRACK_STEPS = 96;
// What is left after the last piece goes on as if each were like this one; it finds a way out sooner or later.
const float MOST_REFLECTED = 0.6;

vec4 random_numbers(int ray, int light, int number) {
  return vec4(pcg4d(uvec4(uint(ray), uint(light), uint(sample_index), uint(number))) >> 8u) * (1.0 / 16777216.0);
}

// Where a line from outside the box enters the grain; false: nowhere.
bool entry_of(vec3 origin, vec3 direction, out vec3 place) {
  vec3 steep = mix(direction, vec3(1e-6), lessThan(abs(direction), vec3(1e-6)));
  vec3 lower = (stored.lower - origin) / steep;
  vec3 upper = (stored.lower + stored.last_node / stored.nodes_a_unit - origin) / steep;
  vec3 first = min(lower, upper), last = max(lower, upper);
  float way = max(first.x, max(first.y, first.z));
  float end = min(last.x, min(last.y, last.z));
  float shortest = SHORTEST_STEP * shortest_spacing();
  float before = way;
  float above_before = 0.0;
  for (int i = 0; i < 64 && way < end; ++i) {
    float above = distance_at(origin + way * direction);
    if (above <= 0.002 * shortest_spacing()) {
      place = origin + mix(way, before, clamp(-above / max(above_before - above, 1e-9), 0.0, 1.0)) * direction;
      return true;
    }
    before = way;
    above_before = above;
    way += max(above, shortest);
  }
  return false;
}

// Weighted by `weight`, one of all that ask is drawn: the one whose exponential waiting time is shortest (Efraimidis and Spirakis, "Weighted random
// sampling with a reservoir", 2006), which the upper bits tell, on a scale of logarithms.
uint draw_key(float weight, float random, uint self) {
  float waiting = -log(max(1.0 - random, 1e-8)) / weight;
  uint order = uint(clamp((24.0 - log2(max(waiting, 1e-12))) * 128.0, 1.0, 8191.0));
  return order << WHO_BITS | self;
}

// What a light's irradiance counts.
float mean_irradiance(int light) { return dot(lights[light].irradiance.rgb, vec3(1.0 / 3.0)); }

float irradiance_of_all() {
  float sum = 0.0;
  for (int i = 0; i < lights.length(); ++i) sum += mean_irradiance(i);
  return sum;
}

void leave_track(int ray, int piece, int light, vec3 place, vec3 direction, float way, float flux) {
  vec3 side = cell_side();
  float volume = side.x * side.y * side.z;
  int steps = clamp(int(ceil(way / min(side.x, min(side.y, side.z)))), 1, MOST_TRACK_STEPS);
  float step = way / float(steps);
  for (int i = 0; i < steps; ++i) {
    vec4 random = random_numbers(ray, light, 1 + piece * MOST_TRACK_STEPS + i);
    float at = (float(i) + random.x) * step;
    ivec3 cell = cell_at(place + at * direction);
    float amount = flux * step / (volume * share_inside(cell)) * exp(-tracked_sigma_t() * at);
    uint count = uint(amount * TRACK_UNIT + random.y);
    if (count == 0u) continue;
    ivec3 texel = cell_texel(cell, light);
    imageAtomicAdd(tracks, texel, count);
    imageAtomicMax(drawn_rays, texel, draw_key(amount, random.z, who(ray, piece, light)));
  }
}

void main() {
  int light = int(gl_WorkGroupID.y);
  int ray = int(gl_WorkGroupID.x) * GROUP + int(gl_LocalInvocationIndex);
  vec3 direction = -(grain_to_body() * lights[light].to_light.xyz);
  vec3 first = perpendicular(direction), second = cross(direction, first);
  vec3 half_box = 0.5 * stored.last_node / stored.nodes_a_unit;
  vec2 reach = vec2(dot(abs(first), half_box), dot(abs(second), half_box));
  vec4 random = random_numbers(ray, light, 0);
  vec2 at = 2.0 * (vec2(ray % RAYS_ACROSS, ray / RAYS_ACROSS) + random.xy) / float(RAYS_ACROSS) - 1.0;
  vec3 place;
  vec3 origin = stored.lower + half_box + at.x * reach.x * first + at.y * reach.y * second - 2.0 * length(half_box) * direction;
  if (!entry_of(origin, direction, place)) return;
  vec3 normal = outwards_at(place);
  float cosine = -dot(normal, direction);
  if (cosine <= 0.0) return;
  float refracted = refracted_cosine(cosine, stored.eta);
  float area = 4.0 * reach.x * reach.y / float(RAYS_ACROSS * RAYS_ACROSS);
#ifdef TOGETHER
  float all = irradiance_of_all();
  float share = mean_irradiance(light) / max(all, 1e-30);
  vec3 colour = lights[light].irradiance.rgb / max(share, 1e-30);
  area *= share;
#endif
  float left = fresnel_transmittance(cosine, refracted, stored.eta);
  direction = normalize((direction + cosine * normal) / stored.eta - refracted * normal);
  float before = 0.0;
  for (int piece = 0; piece < PIECES; ++piece) {
    float way = way_through(place, direction, FAR);
    vec3 end = place + way * direction;
    normal = outwards_at(end);
    cosine = dot(normal, direction);
    float again = cosine > 0.0 ? fresnel_reflectance(min(cosine, 1.0), 1.0 / stored.eta) : 0.0;
    float passed = exp(-tracked_sigma_t() * way);
    float lasting = piece + 1 < PIECES ? 1.0 : 1.0 / (1.0 - min(again, MOST_REFLECTED) * passed);
    ivec3 texel = piece_texel(ray, piece, light);
    imageStore(pieces, texel, vec4(place, before));
    imageStore(pieces, texel + ivec3(0, 0, 1), vec4(direction, 0.0));
#ifdef TOGETHER
    imageStore(pieces, texel + ivec3(0, 0, 2), vec4(colour, lights[light].irradiance.w));
#endif
    leave_track(ray, piece, light, place, direction, way, area * left * lasting);
    left *= again * passed;
    if (left < LEAST_FLUX) return;
    before += way;
    place = end;
    direction -= 2.0 * cosine * normal;
  }
}

// What a grain of a heap sends out because of what other grains send, beside what its model makes of the lights: solved beforehand for all
// grains (native/heap/exchange.h), four numbers a channel.
//
// What is chosen at compile time:
//   EXCHANGE             light goes from grain to grain
//   GATHERED             and was gathered for some pixels
//   TOLD                 what has entered the grain of lights' light and the world's is told, too
#include "render/bindings.glsl"

#ifdef EXCHANGE
// Of each object: x: where its kind is, or -1; z: its radius; w: where what is told of it is, of a grain with a seat of its own; less than 0, of
// one that shares a cell's; 0, of a wall. y: of a wall, which it is; of a grain with a seat of its own, where the second order of what it
// answers is, or 0; of one that shares, where in the cell it is (heap/seats.h): of three numbers of 8 bits, 128 is the middle.
// Of each kind: mean free paths across its radius, and whether it is known where light comes in (models/entries.glsl); the lobe of its answer at
// the middles of intervals of the cosine (w of the first two: how much of the normal and of the direction to the viewer is in seen_place, of
// what is not transparent); the same of what has entered it; those entries.
// Of each seat of one grain: red, green and blue of what it answers, and of what is seen straight through it (xyz: the slope over the normal or
// the look, w: the mean over all of them); how much of the world is seen through it (the same); where any grain is turbid, what has entered it of
// lights' light and the world's, as what it answers, and the second order of that; the second order of what it answers, if any, w of the world.
// Of each cell: what its middle answers, and how that grows along three axes.
layout(std430, binding = HEAP_LIGHT_BINDING) readonly buffer HeapLight { vec4 heap_light[]; };

const int LOBE_NODES = 16;
const int OPEN_NUMBER = 6;  // of a seat
const int ENTERED_NUMBER = 7;
#endif

#include "heap/light_of_walls.glsl"

#ifdef EXCHANGE
vec3 light_at_normal(int first, vec3 normal) {
  vec4 basis = vec4(normal, 1.0);
  return vec3(dot(heap_light[first], basis), dot(heap_light[first + 1], basis), dot(heap_light[first + 2], basis));
}

// As heap::Seats::of.
vec3 light_of_cell_at(int first, float packed_place, vec3 normal) {
  uint place = uint(packed_place);
  vec3 in_cell = sqrt(3.0) / 127.0 * (vec3(place & 255u, (place >> 8u) & 255u, place >> 16u) - 128.0);
  return light_at_normal(first, normal) + in_cell.x * light_at_normal(first + 3, normal) + in_cell.y * light_at_normal(first + 6, normal) +
         in_cell.z * light_at_normal(first + 9, normal);
}

// As heap::second_order.
vec3 second_order_at(int first, vec3 p) {
  vec3 mixed = heap_light[first].rgb * (p.x * p.y) + heap_light[first + 1].rgb * (p.y * p.z) + heap_light[first + 2].rgb * (p.z * p.x);
  vec3 squares = heap_light[first + 3].rgb * (0.5 * (p.x * p.x - p.y * p.y));
  return sqrt(3.0) * (mixed + squares) + heap_light[first + 4].rgb * (p.z * p.z - 0.5 * (p.x * p.x + p.y * p.y));
}

#ifdef GATHERED
// w: 1 where a grain was looked at, 2 where its model tells how much crosses it; 3 and how much of that leaves the heap, where no more than that
// and what is seen straight through it was looked for.
uniform sampler2D gathered;
uniform sampler2D gathered_lights;  // and the world, seen through clear grains; where w is 2, all that is behind one
#endif

// The mean place of what is seen, as heap::GrainTable::seen_place has it; w of a kind its scale.
vec3 seen_place(int kind, vec3 normal, vec3 to_viewer, float mu) {
  vec3 sigma_t = heap_light[kind].rgb;
  float depth = min(2.0 * mu * (sigma_t.r + sigma_t.g + sigma_t.b) / 3.0, 60.0);
  if (sigma_t.r > 1e29) return heap_light[kind + 1].w * normal + heap_light[kind + 2].w * to_viewer;
  float along = depth < 0.05 ? mu * (1.0 - depth / 6.0) : 2.0 * mu * (1.0 / depth - 1.0 / (exp(depth) - 1.0));
  return heap_light[kind].w * (normal - along * to_viewer);
}

// As heap::look_through.
vec3 look_through(vec3 normal, vec3 to_viewer, float mu) { return normalize((2.0 * mu + 1.0) * to_viewer - normal); }

vec3 lobe_at(int lobe, float mu) {
  float node = clamp(mu * float(LOBE_NODES) - 0.5, 0.0, float(LOBE_NODES - 1));
  int below = min(int(node), LOBE_NODES - 2);
  return mix(heap_light[lobe + below].rgb, heap_light[lobe + 1 + below].rgb, node - float(below));
}

// Radiance towards a viewer; of a wall at `place` in the heap.
vec3 light_from_grains(int object_number, vec3 place, vec3 normal, vec3 to_viewer) {
#ifdef GATHERED
  vec4 found = texelFetch(gathered, ivec2(gl_FragCoord.xy), 0);
  if (found.w > 0.0) return found.rgb;
#endif
  vec4 object = heap_light[object_number];
  int kind = int(object.x);
  if (kind < 0) return vec3(0.0);
  float mu = max(dot(normal, to_viewer), 0.0);  // a bent normal may look away
  vec3 lobe = lobe_at(kind + 1, mu);
  if (object.w == 0.0) return lobe * light_of_wall(int(object.y), place, normal);
  vec3 seen = seen_place(kind, normal, to_viewer, mu);
  int first = int(abs(object.w));
  if (object.w < 0.0) return lobe * max(light_of_cell_at(first, object.y, seen), vec3(0.0));
  vec3 crossing = exp(-2.0 * mu * heap_light[kind].rgb);
  vec3 through = look_through(normal, to_viewer, mu);
  vec3 answer = light_at_normal(first, seen);
  int second = int(object.y);
  if (second > 0) answer += second_order_at(second, seen);
  return lobe * max(answer, vec3(0.0)) + crossing * max(light_at_normal(first + 3, through), vec3(0.0));
}

#ifdef TOLD
// Radiance towards a viewer of what lights and the world do in a grain, but for what its surface reflects of them.
vec3 light_entered(int object_number, vec3 normal, vec3 to_viewer) {
  vec4 object = heap_light[object_number];
  int kind = int(object.x);
  if (kind < 0 || object.w <= 0.0) return vec3(0.0);  // what shares a cell's light lies too deep
  int lobe = kind + 1 + LOBE_NODES;
  vec3 place = heap_light[lobe].w * normal + heap_light[lobe + 1].w * to_viewer;
  int first = int(object.w) + ENTERED_NUMBER;
  vec3 light = light_at_normal(first, place) + second_order_at(first + 3, place);
  return lobe_at(lobe, max(dot(normal, to_viewer), 0.0)) * max(light, vec3(0.0));
}
#endif
#endif

// Whether what is behind the grain was looked at through its own facets, so that the model is asked how much of it crosses.
bool looked_through() {
#if defined(EXCHANGE) && defined(GATHERED)
  return texelFetch(gathered, ivec2(gl_FragCoord.xy), 0).w == 2.0;
#else
  return false;
#endif
}

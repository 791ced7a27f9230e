// How much of the world is in what is seen unscattered through the grain that a pixel shows: others may stand before it.
//
// What is chosen at compile time:
//   EXCHANGE             that is known (native/heap/links.h); else none does
//   GATHERED             what is seen through some grains was gathered for each pixel, the world with it
#include "heap/light_from_grains.glsl"
#include "scene/grain.glsl"
#include "scene/world.glsl"

// Of each part of what crosses.
vec3 seen_behind(vec3 direction) {
  if (looked_through()) return vec3(1.0);
#ifdef WORLD
  return seen_of_world(direction);
#else
  return vec3(0.0);
#endif
}

float open_beyond(vec3 normal, vec3 to_viewer) {
#ifdef EXCHANGE
#ifdef GATHERED
  if (looked_through()) return 1.0;
  if (texelFetch(gathered, ivec2(gl_FragCoord.xy), 0).w > 0.0) return 0.0;
#endif
  int first = OBJECT_NUMBERS * grain_instance;
  int kind = int(heap_light[first + 6].x);
  if (kind < 0) return 0.0;
  float mu = dot(normal, to_viewer);
  bool refracts = heap_light[kind].r > 1e29;
  vec3 p = refracts ? seen_place(kind, normal, to_viewer, mu) : look_through(normal, to_viewer, mu);
  float open = dot(heap_light[first + 7], vec4(p, 1.0));
  int second = int(heap_light[first + 6].w);
  if (refracts && second > 0) {
    // As heap::second_order; in the w of what the grain answers.
    vec3 mixed = vec3(heap_light[second].w, heap_light[second + 1].w, heap_light[second + 2].w);
    vec3 squares = p * p;
    open += sqrt(3.0) * (dot(mixed, p * p.yzx) + 0.5 * heap_light[second + 3].w * (squares.x - squares.y));
    open += heap_light[second + 4].w * (squares.z - 0.5 * (squares.x + squares.y));
  }
  return clamp(open, 0.0, 1.0);
#else
  return 1.0;
#endif
}

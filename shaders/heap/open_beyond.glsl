// How much of the world is in what is seen unscattered through the grain that a pixel shows: others may stand before it.
//
// What is chosen at compile time:
//   EXCHANGE             that is known (native/heap/links.h), if no later pass looks (SEES_BEHIND); else none does
//   GATHERED             what is seen through some grains was gathered for each pixel, the world with it
//   BACKDROP             the camera, which looks straight through the grain, sees the world otherwise than it lights
//   FILM_TRANSPARENT     or not at all: what it sees of it makes the picture transparent
//   SEES_BEHIND          something else may stand there: a later pass looks
//   MIRRORED             the viewer is another surface: the camera behind it, if what it passes on goes straight on
#include "heap/light_from_grains.glsl"
#include "scene/grain.glsl"
#include "scene/world.glsl"

#ifdef BACKDROP
uniform vec3 backdrop_radiance;
uniform int backdrop_has_image;
uniform mat3 world_to_backdrop;
uniform sampler2D backdrop_image;
#endif

// Of each part of what crosses and is refracted.
vec3 seen_behind(vec3 direction) {
  if (looked_through()) return vec3(1.0);
#ifdef WORLD
  return seen_of_world(direction);
#else
  return vec3(0.0);
#endif
}

// Of what goes on straight on, `left` of it.
vec3 seen_straight_on(vec3 left, vec3 direction) {
#if defined(FILM_TRANSPARENT) || defined(BACKDROP)
#ifdef MIRRORED
  bool as_camera = passed_on().w > 0.0;
#else
  const bool as_camera = true;
#endif
  vec3 radiance;
  if (!as_camera) {
    radiance = left * seen_behind(direction);
  } else {
#ifdef FILM_TRANSPARENT
    film_seen = left;
    radiance = vec3(0.0);
#else
    radiance = left * radiance_around(backdrop_radiance, backdrop_has_image, world_to_backdrop, backdrop_image, direction);
#endif
  }
#else
  vec3 radiance = left * seen_behind(direction);
#endif
#ifdef SEES_BEHIND
  mirrored = Mirrored(portion(TRANSMISSION_PORTION, radiance), portion(TRANSMISSION_PORTION, left), direction);
  return vec3(0.0);
#else
  return radiance;
#endif
}

float open_beyond(vec3 normal, vec3 to_viewer) {
#if defined(EXCHANGE) && !defined(SEES_BEHIND)
#ifdef GATHERED
  float looked = texelFetch(gathered, ivec2(gl_FragCoord.xy), 0).w;
  if (looked >= 3.0) return looked - 3.0;
  if (looked > 0.0) return float(looked_through());
#endif
  vec4 object = heap_light[grain_instance];
  if (object.w <= 0.0) return 0.0;
  int kind = int(object.x);
  float mu = dot(normal, to_viewer);
  bool refracts = heap_light[kind].r > 1e29;
  vec3 p = refracts ? seen_place(kind, normal, to_viewer, mu) : look_through(normal, to_viewer, mu);
  float open = dot(heap_light[int(object.w) + OPEN_NUMBER], vec4(p, 1.0));
  int second = int(object.y);
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

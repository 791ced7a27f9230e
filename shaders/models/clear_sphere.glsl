// What models 2 and 3 let cross the grain unscattered: the world, refracted as by the sphere with the grain's mean chord, with its reflections
// inside. Light meets the inside of a sphere at the same angle ever again, so that nothing but the direction changes on the way.
// Not physical: facets look into a ball; only the world is seen, as far as none of the others stands before it; where that is not known, without
// light between grains, an instance shows none.
//
// What is chosen at compile time (models::add_body_uniforms), besides what dielectric.glsl names:
//   EXCHANGE             it is known how much of the world others leave
//   CLEAR, WORLD         so much crosses the sphere unscattered that it is seen, and there is a world
#include "heap/open_beyond.glsl"
#include "models/dielectric.glsl"
#include "models/interface.glsl"
#include "physics/prelude.glsl"
#include "physics/fresnel.glsl"
#include "scene/world.glsl"

#ifdef CLEAR
// Per radius of the sphere; what is scattered within the phase function's forward peak goes on.
uniform vec3 clear_sigma_a;
uniform vec3 clear_sigma_s;
uniform float clear_eta;

#if defined(WORLD) || defined(GATHERED)
// What leaves the sphere is followed until so little of it is left.
const float LEAST_CLEAR = 0.004;
const int MOST_CHORDS = 6;

vec3 crossing_light(SurfacePoint point, Outwards outwards) {
#if defined(INSTANCED) && !defined(EXCHANGE)
  return vec3(0.0);
#endif
  // A look through the grain's own facets is absorbed on its own way.
  vec3 sigma_t = looked_through() ? clear_sigma_s : clear_sigma_s + clear_sigma_a;
  vec3 passed = exp(-2.0 * outwards.mu_refracted * sigma_t);
  vec3 left = open_beyond(point.normal, point.to_viewer) * outwards.transmittance * passed;
#ifdef REFRACTION
  vec3 normal = point.normal;
  vec3 direction = (outwards.mu * normal - point.to_viewer) / clear_eta - outwards.mu_refracted * normal;
  float leaves = fresnel_transmittance(outwards.mu, outwards.mu_refracted, clear_eta);
  float again = max(1.0 - leaves, 0.0);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < MOST_CHORDS; ++i) {
    normal += 2.0 * outwards.mu_refracted * direction;  // where the chord ends
    vec3 outside = normalize(clear_eta * (direction - outwards.mu_refracted * normal) + outwards.mu * normal);
    bool last = i + 1 == MOST_CHORDS || max(left.r, max(left.g, left.b)) * again < LEAST_CLEAR;
    // What is left then leaves by and by, as if all of it looked this way.
    vec3 share = last ? leaves / max(1.0 - again * passed, 1e-6) : vec3(leaves);
    sum += left * share * seen_behind(outside);
    if (last) break;
    left *= again * passed;
    direction -= 2.0 * outwards.mu_refracted * normal;
  }
  return sum;
#else
  return seen_straight_on(left, -point.to_viewer);
#endif
}
#endif
#endif

// Light that nothing has scattered yet, at a place inside one prototype: which way it came, and from how far.
// Not physical: where refraction gathers light from several places on the surface, one of them is found.
//
// What is chosen at compile time: REFRACTION, and CONVEX as in stored_grid.glsl.
#include "models/directions.glsl"
#include "models/stored_grid.glsl"
#include "physics/prelude.glsl"
#include "physics/fresnel.glsl"

struct Unscattered {
  vec3 back;         // towards where it came in
  float way;         // in the grain from there
  float irradiance;  // on a plane that faces it, were nothing lost on the way; of parallel light of irradiance 1
};

#ifdef REFRACTION
uniform sampler3D smooth_slopes;  // of `distances`, smoothed by their neighbours, at the nodes that light is known at

const float LEAST_WIDTH = 0.2;  // of a bundle of light, over what it was as it entered: a narrower one is seen by few places

// What outwards_at says, with edges rounded off over two nodes: so light enters, of whose ways in one is looked for.
vec3 outwards_where_light_enters(vec3 place) { return unit_vector(texture(smooth_slopes, (to_nodes(place) + 0.5) / (stored.last_node + 1.0)).xyz); }

// Towards where light comes from that was refracted at a surface of this normal; grazing light where the surface faces away.
vec3 back_to_entry(vec3 to_light, vec3 normal) {
  float cosine = dot(normal, to_light);
  vec3 aside = to_light - cosine * normal;
  if (cosine < 0.0) aside = unit_vector(aside);
  return unit_vector(aside / stored.eta + refracted_cosine(max(cosine, 0.0), stored.eta) * normal);
}

const int TRIES = 4;  // fewer stop before where light comes in at grazing angles: a third too much where g is 0.95

// Light that comes in where a line from the place meets the surface passes beside the place; how far, and how that changes with where it comes in,
// tells where light comes in that does not (a step of Newton's method).
Unscattered unscattered_at(vec3 place, vec3 to_light) {
  vec3 back = to_light;
  float way;
  vec3 entry;
  vec3 normal;
  for (int i = 0; i < TRIES; ++i) {
    way = way_through(place, back, FAR);
    entry = place + way * back;
    normal = outwards_where_light_enters(entry);
    back = back_to_entry(to_light, normal);
  }
  float refracted = max(dot(normal, back), 0.1);
  vec3 first = perpendicular(back);
  vec3 second = cross(back, first);
  vec3 along_first = first - dot(normal, first) / refracted * back;
  vec3 along_second = second - dot(normal, second) / refracted * back;
  float aside = 0.5 * min(1.0 / stored.nodes_a_unit.x, min(1.0 / stored.nodes_a_unit.y, 1.0 / stored.nodes_a_unit.z));
  vec3 normal_first = outwards_where_light_enters(entry + aside * along_first);
  vec3 normal_second = outwards_where_light_enters(entry + aside * along_second);
  vec3 turn_first = (back_to_entry(to_light, normal_first) - back) / aside;
  vec3 turn_second = (back_to_entry(to_light, normal_second) - back) / aside;
  mat2 spread = mat2(1.0) - way * mat2(dot(turn_first, first), dot(turn_first, second), dot(turn_second, first), dot(turn_second, second));
  float wide = determinant(spread);
  if (abs(wide) < LEAST_WIDTH) wide = wide < 0.0 ? -LEAST_WIDTH : LEAST_WIDTH;
  vec3 missed = place - entry + way * back;
  vec2 beside = vec2(dot(missed, first), dot(missed, second));
  vec2 move = vec2(spread[1][1] * beside.x - spread[1][0] * beside.y, spread[0][0] * beside.y - spread[0][1] * beside.x) / wide;
  move *= min(1.0, aside / max(length(move), 1e-9));  // the surface may bend otherwise farther off
  back = unit_vector(back + move.x * turn_first + move.y * turn_second);
  way = length(entry + move.x * along_first + move.y * along_second - place);
  normal = unit_vector(normal + (move.x * (normal_first - normal) + move.y * (normal_second - normal)) / aside);
  float cosine = dot(normal, to_light);
  if (cosine <= 0.0) return Unscattered(back, way, 0.0);
  refracted = refracted_cosine(cosine, stored.eta);
  return Unscattered(back, way, fresnel_transmittance(cosine, refracted, stored.eta) * cosine / (refracted * abs(wide)));
}
#else
#ifdef CONVEX
float way_of_light(vec3 place, vec3 to_light) { return way_out(place, to_light, FAR); }
#else
const int MOST_STEPS_ASIDE = 128;

// How much of the straight line to a light is inside the grain, which it may leave and enter again.
float way_of_light(vec3 place, vec3 to_light) {
  float furthest = way_to_box(place, to_light);
  float shortest = 2.0 * SHORTEST_STEP * shortest_spacing();
  float before = distance_at(place);
  float way = 0.0;
  float inside = 0.0;
  for (int i = 0; i < MOST_STEPS_ASIDE && way < furthest; ++i) {
    float step = min(max(abs(before), shortest), furthest - way);
    way += step;
    float after = distance_at(place + way * to_light);
    float below = max(-before, 0.0) + max(-after, 0.0);
    inside += step * below / max(abs(before) + abs(after), 1e-9);
    before = after;
  }
  return inside;
}
#endif

Unscattered unscattered_at(vec3 place, vec3 to_light) { return Unscattered(to_light, way_of_light(place, to_light), 1.0); }
#endif

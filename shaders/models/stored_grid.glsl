// Where one prototype's surface is, as far as its nodes tell, and how straight lines go through it.
//
// What is chosen at compile time:
//   CONVEX               no line leaves the grain and enters it again
#include "models/stored_products.glsl"

uniform sampler3D distances;  // from the surface, at nodes of its own; negative inside

// Among the nodes that light is known at.
vec3 to_nodes(vec3 place) { return clamp((place - stored.lower) * stored.nodes_a_unit, vec3(0.0), stored.last_node); }

vec3 to_surface_nodes(vec3 place) { return clamp((place - stored.lower) * stored.surface_nodes_a_unit, vec3(0.0), stored.last_surface_node); }

float distance_at_node(vec3 node) { return texture(distances, (node + 0.5) / (stored.last_surface_node + 1.0)).r; }

float distance_at(vec3 place) { return distance_at_node(to_surface_nodes(place)); }

const float BESIDE = 0.2;  // a node, on either side: how the surface lies there, not in the mean of the nodes around

vec3 outwards_at(vec3 place) {
  vec3 node = to_surface_nodes(place);
  vec3 before = max(node - BESIDE, vec3(0.0));
  vec3 after = min(node + BESIDE, stored.last_surface_node);
  vec3 gradient = vec3(distance_at_node(vec3(after.x, node.yz)) - distance_at_node(vec3(before.x, node.yz)),
                       distance_at_node(vec3(node.x, after.y, node.z)) - distance_at_node(vec3(node.x, before.y, node.z)),
                       distance_at_node(vec3(node.xy, after.z)) - distance_at_node(vec3(node.xy, before.z))) *
                  stored.surface_nodes_a_unit / (after - before);
  return gradient * inversesqrt(max(dot(gradient, gradient), 1e-12));
}

// Steps are to be as short however many nodes the surface has.
float shortest_spacing() {
  vec3 spacing = 0.5 / stored.nodes_a_unit;
  return min(spacing.x, min(spacing.y, spacing.z));
}

// How far it is to the side of the body's box that a line inside it leaves through.
float way_to_box(vec3 place, vec3 direction) {
  vec3 upper = stored.lower + stored.last_node / stored.nodes_a_unit;
  vec3 steep =
      vec3(abs(direction.x) > 1e-6 ? direction.x : 1e-6, abs(direction.y) > 1e-6 ? direction.y : 1e-6, abs(direction.z) > 1e-6 ? direction.z : 1e-6);
  vec3 ways = max((stored.lower - place) / steep, (upper - place) / steep);
  return max(min(ways.x, min(ways.y, ways.z)), 0.0);
}

const float FAR = 1e6;
const float SHORTEST_STEP = 0.3;  // of the way between nodes
const float NEAR_ENOUGH = 0.002;  // to the surface, of the way between nodes
const float ROUNDED_OFF = 2.0;    // ways between nodes: as far into a sharp edge the grid may tell that a place is outside

#ifdef CONVEX
// How far it is until a line leaves the grain, or `longest` if that is less. Along a line the distance from a convex body grows ever faster:
// secants from beyond it come nearer and nearer to where the line leaves, and never come in.
float way_out(vec3 place, vec3 direction, float longest) {
  float far = min(way_to_box(place, direction), longest);  // beyond the box the grid tells nothing
  float above_far = distance_at(place + far * direction);
  float near_enough = NEAR_ENOUGH * shortest_spacing();
  if (above_far <= near_enough) return far;  // a flat side lies on the box's but for rounding
  float way = far - above_far;
  for (int i = 0; i < 8 && way > 0.0; ++i) {
    float above = distance_at(place + way * direction);
    float steep = (above_far - above) / (far - way);
    if (steep <= 0.0) return 0.0;
    far = way;
    above_far = above;
    way -= above / steep;
    if (abs(above) < near_enough) break;
  }
  return max(way, 0.0);
}
#endif

#ifdef CONVEX
// Whether way_through is as long as that.
bool ends_inside(vec3 place, vec3 direction, float way) {
  return way <= SHORTEST_STEP * shortest_spacing() ||
         (way <= way_to_box(place, direction) && distance_at(place + way * direction) <= NEAR_ENOUGH * shortest_spacing());
}
#endif

// How far it is through the grain, or `longest` if that is less. A line that begins at an edge, which the grid rounds off, begins outside.
float way_through(vec3 place, vec3 direction, float longest) {
  float shortest = SHORTEST_STEP * shortest_spacing();
#ifdef CONVEX
  return max(way_out(place, direction, longest), min(shortest, longest));
#else
  float furthest = min(way_to_box(place, direction), longest);  // beyond the box the grid tells nothing
  float rounded_off = ROUNDED_OFF * shortest_spacing();
  float way = shortest;
  float before = 0.0;
  float below = 0.0;
  bool inside = false;
  // By steps as long as the surface is away.
  for (int i = 0; i < 48; ++i) {
    if (way >= furthest) return furthest;
    float above = distance_at(place + way * direction);
    if (above >= 0.0 && (inside || way > rounded_off)) return inside ? mix(before, way, below / max(below + above, 1e-6)) : min(shortest, furthest);
    inside = inside || above < 0.0;
    below = max(-above, 0.0);
    before = way;
    way += max(below, shortest);
  }
  return way;
#endif
}

#ifndef CONVEX
// How far it is outside the grain, from where a line leaves it, to where it enters it again; negative: nowhere.
float way_to_next_entry(vec3 place, vec3 direction) {
  float furthest = way_to_box(place, direction);
  float shortest = SHORTEST_STEP * shortest_spacing();
  float way = shortest;
  float before = 0.0;
  bool outside = false;  // rounding may leave the beginning inside
  for (int i = 0; i < 48 && way < furthest; ++i) {
    float above = distance_at(place + way * direction);
    if (above > shortest) outside = true;
    if (outside && above <= 0.0) return mix(way - max(before, shortest), way, before / max(before - above, 1e-9));
    if (above < -shortest) return way;  // it was hardly outside, along the surface
    before = max(above, 0.0);
    way += max(above, shortest);
  }
  return -1.0;
}
#endif

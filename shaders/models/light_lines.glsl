// Straight lines from each of a sample's suns through one prototype that does not refract, cut at its surface beforehand
// (passes/cut_light_lines.comp): how much of the way from a place to a sun is inside is looked up, where following it takes many steps.
#include "models/directions.glsl"
#include "models/stored_grid.glsl"

// Lines of one light stand in a square across it, which the body's box fills.
struct Across {
  vec3 first;
  vec3 second;
  vec2 reach;
};

vec3 half_box() { return 0.5 * stored.last_node / stored.nodes_a_unit; }

Across across(vec3 to_light) {
  vec3 first = perpendicular(to_light), second = cross(to_light, first);
  return Across(first, second, vec2(dot(abs(first), half_box()), dot(abs(second), half_box())));
}

#ifdef LIGHT_LINES
// Layers of lights, a texel a line: where along it, from the box's middle towards the light, it is inside the grain: from x to y, and from z to w.
uniform sampler3D light_lines;

// x: how much of it is inside from there on, y: whether it meets the grain at all; times a share.
vec2 inside_from(float along, vec4 line, float share) {
  float way = max(line.y - max(line.x, along), 0.0) + max(line.w - max(line.z, along), 0.0);
  return line.y > line.x ? share * vec2(way, 1.0) : vec2(0.0);
}

// How much of the straight line to a light is inside the grain, in the mean of those of the four lines beside it that meet it.
float way_of_light(vec3 place, vec3 to_light, int light) {
  vec3 from_middle = place - stored.lower - half_box();
  Across lines = across(to_light);
  int last = textureSize(light_lines, 0).x - 1;
  vec2 at = (0.5 + 0.5 * vec2(dot(from_middle, lines.first), dot(from_middle, lines.second)) / lines.reach) * float(last);
  ivec2 line = clamp(ivec2(at), ivec2(0), ivec2(last - 1));
  vec2 share = clamp(at - vec2(line), vec2(0.0), vec2(1.0));
  float along = dot(from_middle, to_light);
  vec2 sum = inside_from(along, texelFetch(light_lines, ivec3(line, light), 0), (1.0 - share.x) * (1.0 - share.y));
  sum += inside_from(along, texelFetch(light_lines, ivec3(line.x + 1, line.y, light), 0), share.x * (1.0 - share.y));
  sum += inside_from(along, texelFetch(light_lines, ivec3(line.x, line.y + 1, light), 0), (1.0 - share.x) * share.y);
  sum += inside_from(along, texelFetch(light_lines, ivec3(line.x + 1, line.y + 1, light), 0), share.x * share.y);
  return sum.x / max(sum.y, 1e-9);
}
#endif

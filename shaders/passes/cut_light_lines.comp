// Follows straight lines from each of a sample's suns through a prototype and leaves where they are inside it: models/light_lines.glsl looks there.
#include "render/bindings.glsl"
#include "render/distant_light.glsl"
#include "models/light_lines.glsl"

const int GROUP = 64;  // lines of one light
layout(local_size_x = GROUP) in;

layout(std430, binding = DISTANT_LIGHTS_BINDING) readonly buffer Lights { DistantLight lights[]; };

layout(rgba32f, binding = 0) writeonly uniform image3D lines;

const int MOST_STEPS_ALONG = 160;

void main() {
  int number = int(gl_WorkGroupID.x) * GROUP + int(gl_LocalInvocationIndex);
  int light = int(gl_WorkGroupID.y);
  int side = imageSize(lines).x;
  if (number >= side * side) return;
  ivec2 line = ivec2(number % side, number / side);
  vec3 to_light = grain_to_body() * lights[light].to_light.xyz;
  Across square = across(to_light);
  vec2 aside = (2.0 * vec2(line) / float(side - 1) - 1.0) * square.reach;
  // From the middle, where the line is in the box.
  vec3 origin = aside.x * square.first + aside.y * square.second;
  vec3 steep = mix(to_light, vec3(1e-6), lessThan(abs(to_light), vec3(1e-6)));
  vec3 a = (-half_box() - origin) / steep, b = (half_box() - origin) / steep;
  vec3 lows = min(a, b), highs = max(a, b);
  float from = max(lows.x, max(lows.y, lows.z));
  float along = min(highs.x, min(highs.y, highs.z));
  origin += stored.lower + half_box();
  vec4 inside = vec4(0.0);
  int pieces = 0;
  float shortest = SHORTEST_STEP * shortest_spacing();
  float before = max(distance_at(origin + along * to_light), 0.0);
  float entered = along;
  for (int i = 0; i < MOST_STEPS_ALONG && along > from; ++i) {
    float step = min(max(abs(before), shortest), along - from);
    along -= step;
    float after = distance_at(origin + along * to_light);
    bool ends = along <= from;
    float crossed = along + step * abs(after) / max(abs(before) + abs(after), 1e-9);
    if (before >= 0.0 && after < 0.0) {
      entered = crossed;
    }
    if (before < 0.0 && (after >= 0.0 || ends)) {
      float left = after >= 0.0 ? crossed : along;
      if (pieces == 0)
        inside.xy = vec2(left, entered);
      else if (pieces == 1)
        inside.zw = vec2(left, entered);
      else
        inside.z -= entered - left;  // what is behind two others counts as part of the second
      ++pieces;
    }
    before = after;
  }
  imageStore(lines, ivec3(line, light), inside);
}

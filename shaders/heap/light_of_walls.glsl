// What a ground, a bowl or a wall sends out because of what the grains and the rest of it send: known at the nodes of grids on its surface
// (native/heap/patches.h), linear between them.

#ifdef EXCHANGE
// Bits of floats: the middle of the grids, the length of their finest cells; half the box around the grains, and the size of the cells' table
// less 1; where the values of the nodes begin in heap_light. Then of each cell where it is, and its corners' nodes.
layout(std430, binding = WALL_LIGHT_BINDING) readonly buffer WallLight { uvec4 wall_light[]; };

// As native/heap/patches.cpp has them.
const float LEVEL_REACH = 8.0;
const float MIXED_FROM = 0.75;
const float CELL_DEPTH = 2.0;
const int MOST_LEVELS = 24;
const int MOST_PROBES = 8;

uint hash_of_cell(ivec3 at, uint tag) {
  uint bits = uint(at.x) * 73856093u ^ uint(at.y) * 19349663u ^ uint(at.z) * 83492791u ^ tag * 2654435761u;
  bits ^= bits >> 16u;
  bits *= 0x7feb352du;
  return bits ^ (bits >> 15u);
}

vec3 light_of_node(uint node) { return heap_light[wall_light[2].x + node].rgb; }

// `place`: along the axes across the one that the surface faces, and along that.
vec3 light_of_cell(vec3 place, uint tag) {
  vec2 low = floor(place.xy);
  ivec3 at = ivec3(ivec2(low), int(floor(place.z / CELL_DEPTH)));
  uint mask = wall_light[1].w;
  uint slot = hash_of_cell(at, tag) & mask;
  uvec4 cell = wall_light[3u + 2u * slot];
  for (int probe = 1; probe < MOST_PROBES && cell != uvec4(at, tag); ++probe) {
    slot = (slot + 1u) & mask;
    cell = wall_light[3u + 2u * slot];
  }
  if (cell != uvec4(at, tag)) return vec3(0.0);
  uvec4 nodes = wall_light[4u + 2u * slot];
  vec2 share = place.xy - low;
  return mix(mix(light_of_node(nodes.x), light_of_node(nodes.y), share.x), mix(light_of_node(nodes.z), light_of_node(nodes.w), share.x), share.y);
}

// Exitance over pi, of wall `wall` at a place in the heap.
vec3 light_of_wall(int wall, vec3 place, vec3 normal) {
  vec3 from_middle = place - uintBitsToFloat(wall_light[0].xyz);
  float spacing = uintBitsToFloat(wall_light[0].w);
  vec3 beyond = abs(from_middle) - uintBitsToFloat(wall_light[1].xyz);
  vec3 size = abs(normal);
  int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  vec3 turned = axis == 0 ? from_middle.yzx : axis == 1 ? from_middle.zxy : from_middle;
  float facing = axis == 0 ? normal.x : axis == 1 ? normal.y : normal.z;
  uint tag = uint(wall) << 8u | uint(2 * axis + (facing < 0.0 ? 1 : 0)) << 5u;
  float levels = max(max(beyond.x, beyond.y), max(beyond.z, 0.0)) / (LEVEL_REACH * spacing);
  int level = levels < 1.0 ? 0 : min(int(log2(levels)) + 1, MOST_LEVELS - 1);
  float share = clamp((levels * exp2(-float(level)) - MIXED_FROM) / (1.0 - MIXED_FROM), 0.0, 1.0);
  vec3 in_cells = turned * (exp2(-float(level)) / spacing);
  vec3 light = light_of_cell(in_cells, tag | uint(level));
  if (share <= 0.0) return light;
  return mix(light, light_of_cell(0.5 * in_cells, tag | uint(min(level + 1, MOST_LEVELS - 1))), share);
}
#endif

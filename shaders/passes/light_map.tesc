// How finely a triangle of a light map is drawn: until its flat pieces are the curved surface for all that a texel can tell.

#include "passes/curved_surface.glsl"
#include "physics/prelude.glsl"
#include "physics/curved_edge.glsl"

layout(vertices = 3) out;

in Corner {
  vec3 position;
  vec3 normal;
}
corners[];

out Corner {
  vec3 position;
  vec3 normal;
}
patch_corners[];

uniform float largest_rise;  // of a piece above its flat triangle, in scene units

// The same from both of an edge's triangles, so that nothing shines through between them.
float pieces(int a, int b) {
  float rise = edge_rise(corners[a].position, corners[a].normal, corners[b].position, corners[b].normal);
  return clamp(ceil(sqrt(rise / largest_rise)), 1.0, 64.0);
}

void main() {
  patch_corners[gl_InvocationID].position = corners[gl_InvocationID].position;
  patch_corners[gl_InvocationID].normal = corners[gl_InvocationID].normal;
  if (gl_InvocationID != 0) return;
  gl_TessLevelOuter[0] = pieces(1, 2);
  gl_TessLevelOuter[1] = pieces(2, 0);
  gl_TessLevelOuter[2] = pieces(0, 1);
  gl_TessLevelInner[0] = max(gl_TessLevelOuter[0], max(gl_TessLevelOuter[1], gl_TessLevelOuter[2]));
}

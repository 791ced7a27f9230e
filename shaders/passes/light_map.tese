// A corner of a piece of a light map's triangle, on the curved surface.

#include "passes/curved_surface.glsl"

layout(triangles, equal_spacing, ccw) in;

in Corner {
  vec3 position;
  vec3 normal;
}
patch_corners[];

out Corner {
  vec3 position;
  vec3 normal;
}
corner;

uniform mat4 light_to_clip;

void main() {
  // Precise, so that two triangles agree to the last bit about the edge between them.
  precise vec3 flat_position = vec3(0.0);
  precise vec3 normal = vec3(0.0);
  precise float plane_offset = 0.0;
  for (int i = 0; i < 3; ++i) {
    flat_position += gl_TessCoord[i] * patch_corners[i].position;
    normal += gl_TessCoord[i] * patch_corners[i].normal;
    plane_offset += gl_TessCoord[i] * tangent_plane_offset(patch_corners[i].position, patch_corners[i].normal);
  }
  corner.position = on_curved_surface(flat_position, normal, plane_offset);
  corner.normal = normal;
  gl_Position = light_to_clip * vec4(corner.position, 1.0);
}

// One texel of a light map. Front faces write the first three numbers, back faces the fourth; the colour mask chooses.

#include "passes/curved_surface.glsl"

in vec3 light_position;
in vec3 light_normal;
in float light_plane_offset;

out vec4 texel;

void main() {
  vec3 normal = normalize(light_normal);
  vec3 curved = on_curved_surface(light_position, light_normal, light_plane_offset);
  // The curved surface's place lies beside the texel's middle: back to that along the surface, but not far where it runs along the light.
  vec2 aside = light_position.xy - curved.xy;
  float climb = -dot(normal.xy, aside) / (sign(normal.z) * max(abs(normal.z), 0.05));
  texel = vec4(curved.z + climb, normal.xy, curved.z + climb);
}

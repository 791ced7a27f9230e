// One texel of a light map. Front faces write the first three numbers, back faces the fourth; the colour mask chooses.

in Corner {
  vec3 position;
  vec3 normal;
}
corner;

out vec4 texel;

void main() { texel = vec4(corner.position.z, normalize(corner.normal).xy, corner.position.z); }

// One texel of a light map. Front faces write the first three numbers, back faces the fourth; the colour mask chooses.

in float light_depth;
in vec3 light_normal;

out vec4 texel;

void main() {
  vec3 normal = normalize(light_normal);
  texel = vec4(light_depth, normal.xy, light_depth);
}

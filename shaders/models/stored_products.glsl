// Light's transport in one prototype as it is stored: products of a function of the place and one of the light's direction.
//
// What is chosen at compile time, as in transport.glsl: GREY, MANY_TERMS, MORE_TERMS, MOST_TERMS, REFRACTION, INSTANCED.
struct Stored {
  vec3 x_axis;  // of the body, in the prototype's
  vec3 y_axis;
  vec3 z_axis;
  vec3 lower;  // the first node; lengths are in units of the body
  vec3 nodes_a_unit;
  vec3 last_node;
  vec3 surface_nodes_a_unit;  // the surface has nodes of its own
  vec3 last_surface_node;
  vec3 sigma_t;
  float units;  // of the body, a scene unit
  float eta;
  vec3 albedo;
};
uniform Stored stored;
#ifndef INSTANCED
uniform mat3 grain_to_prototype;  // a turn
#endif

#ifdef GREY
#define Spectrum float
#define SPECTRUM(value) (value).r
const int CHANNELS = 1;
#if defined(MOST_TERMS)
const int TERMS = 48;
#elif defined(MORE_TERMS)
const int TERMS = 36;
#elif defined(MANY_TERMS)
const int TERMS = 24;
#else
const int TERMS = 16;
#endif
const int LEADING_TEXELS = 2;
#else
#define Spectrum vec3
#define SPECTRUM(value) (value).rgb
const int CHANNELS = 3;
#if defined(MOST_TERMS)
const int TERMS = 44;
#elif defined(MANY_TERMS)
const int TERMS = 32;
#else
const int TERMS = 20;
#endif
const int LEADING_TEXELS = 1;
#endif

float largest(Spectrum value) {
#ifdef GREY
  return value;
#else
  return max(value.r, max(value.g, value.b));
#endif
}

// Terms of the source function, four a texel: of the place, which all channels share, blocks of nodes behind one another; of the light's direction,
// octahedral maps with frames below one another, channel by channel. Of the place each is over its largest value, by which its map is multiplied. The
// leading terms, of which most is seen, are the last; the others' maps are in bytes, and what they are multiplied by is beside them.
uniform sampler3D sources;
uniform sampler3D lobes;  // one texel deep, as those below
uniform sampler3D lesser_lobes;
uniform sampler2D lesser_scales;

const int TERM_TEXELS = TERMS / 4;
const int LOBE_TEXELS = CHANNELS * TERM_TEXELS;
const int LESSER_TEXELS = TERM_TEXELS - LEADING_TEXELS;

// Of one of `count` maps, at a place in a map, in texels.
vec4 map_texel(sampler3D maps, vec2 place, int map, int count) {
  float framed = float(textureSize(maps, 0).x);
  return texture(maps, vec3(vec2(place.x, place.y + float(map) * framed) / vec2(framed, framed * float(count)), 0.5));
}

// Of four terms a channel's lobes, where light comes from there.
vec4 lobe_texel(vec3 to_light, int number) {
  vec2 square = to_light.xy / (abs(to_light.x) + abs(to_light.y) + abs(to_light.z));
  vec2 side = vec2(square.x < 0.0 ? -1.0 : 1.0, square.y < 0.0 ? -1.0 : 1.0);
  if (to_light.z < 0.0) square = (1.0 - abs(square.yx)) * side;
  vec2 place = 1.0 + (float(textureSize(lobes, 0).x) - 2.0) * (0.5 + 0.5 * square);
  int channel = number / TERM_TEXELS;
  int block = number % TERM_TEXELS;
  if (block >= LESSER_TEXELS) return map_texel(lobes, place, channel * LEADING_TEXELS + block - LESSER_TEXELS, CHANNELS * LEADING_TEXELS);
  int map = channel * LESSER_TEXELS + block;
  return texelFetch(lesser_scales, ivec2(map, 0), 0) * map_texel(lesser_lobes, place, map, CHANNELS * LESSER_TEXELS);
}

mat3 grain_to_body() {
#ifdef INSTANCED
  mat3 grain_to_prototype = transpose(grain_axes);
#endif
  return transpose(mat3(stored.x_axis, stored.y_axis, stored.z_axis)) * grain_to_prototype;
}

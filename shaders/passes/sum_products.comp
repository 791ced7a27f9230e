// Sums what is stored of a prototype for the directions of a sample's lights: the source function of each at every node, so that a pixel reads one
// texel where it would read those of all products.
//
// What is chosen at compile time, besides what models/stored_products.glsl names:
//   TOGETHER             of all lights together, times their irradiances
//   STORED_LIGHTS        of some suns it is stored what they do in the grain
#include "render/bindings.glsl"
#include "render/distant_light.glsl"
#include "models/stored_lights.glsl"
#include "models/stored_products.glsl"

const int GROUP = 64;  // nodes under one light, or under all
layout(local_size_x = GROUP) in;

layout(std430, binding = DISTANT_LIGHTS_BINDING) readonly buffer Lights { DistantLight lights[]; };

#if defined(GREY) && !defined(TOGETHER)
layout(r32f, binding = 0) writeonly uniform image3D sums;
#else
layout(rgba32f, binding = 0) writeonly uniform image3D sums;
#endif

shared vec4 lobe[LOBE_TEXELS];

void take_lobe(int light) {
#ifdef STORED_LIGHTS
  look_for_sun(light);
#endif
  int self = int(gl_LocalInvocationIndex);
  barrier();
  if (self < LOBE_TEXELS) lobe[self] = lobe_texel(grain_to_body() * lights[light].to_light.xyz, self);
  barrier();
}

// Under the light whose lobe was taken. Channels of a grey medium are the same.
vec3 source_of(ivec3 place, int planes) {
#ifdef STORED_LIGHTS
  if (light_block >= 0) {
    vec3 stored_source = texelFetch(light_sources, ivec3(place.xy, place.z + light_block * planes), 0).rgb;
#ifdef GREY
    return stored_source.rrr;
#else
    return stored_source;
#endif
  }
#endif
  vec3 sum = vec3(0.0);
  for (int i = 0; i < TERM_TEXELS; ++i) {
    vec4 terms = texelFetch(sources, ivec3(place.xy, place.z + i * planes), 0);
#ifdef GREY
    sum += dot(terms, lobe[i]);
#else
    sum += vec3(dot(terms, lobe[i]), dot(terms, lobe[TERM_TEXELS + i]), dot(terms, lobe[2 * TERM_TEXELS + i]));
#endif
  }
  return sum;
}

void main() {
  ivec3 size = ivec3(stored.last_node) + 1;
  int node = int(gl_WorkGroupID.x) * GROUP + int(gl_LocalInvocationIndex);
  bool any = node < size.x * size.y * size.z;  // all of a group meet at its barriers
  ivec3 place = ivec3(node % size.x, node / size.x % size.y, node / (size.x * size.y));
#ifdef TOGETHER
  vec3 sum = vec3(0.0);
  for (int light = 0; light < lights.length(); ++light) {
    take_lobe(light);
    if (any) sum += lights[light].irradiance.rgb * source_of(place, size.z);
  }
#else
  int light = int(gl_WorkGroupID.y);
  take_lobe(light);
  vec3 sum = source_of(place, size.z);
  place.z += light * size.z;
#endif
  if (any) imageStore(sums, place, vec4(sum, 0.0));
}

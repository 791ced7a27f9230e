// Sums what is stored of a prototype for the directions of a sample's lights: the source function of each at every node, so that a pixel reads one
// texel where it would read those of all products.
//
// What is chosen at compile time: as in models/stored_products.glsl.
#include "render/bindings.glsl"
#include "render/distant_light.glsl"
#include "models/stored_products.glsl"

const int GROUP = 64;  // nodes under one light
layout(local_size_x = GROUP) in;

layout(std430, binding = DISTANT_LIGHTS_BINDING) readonly buffer Lights { DistantLight lights[]; };

#ifdef GREY
layout(r32f, binding = 0) writeonly uniform image3D sums;
#else
layout(rgba32f, binding = 0) writeonly uniform image3D sums;
#endif

shared vec4 lobe[LOBE_TEXELS];

void main() {
  int light = int(gl_WorkGroupID.y);
  int self = int(gl_LocalInvocationIndex);
  if (self < LOBE_TEXELS) lobe[self] = lobe_texel(grain_to_body() * lights[light].to_light.xyz, self);
  barrier();
  ivec3 size = ivec3(stored.last_node) + 1;
  int node = int(gl_WorkGroupID.x) * GROUP + self;
  if (node >= size.x * size.y * size.z) return;
  ivec3 place = ivec3(node % size.x, node / size.x % size.y, node / (size.x * size.y));
  vec4 sum = vec4(0.0);
  for (int block = 0; block < LOBE_TEXELS; ++block) {
    vec4 texel = texelFetch(sources, ivec3(place.xy, place.z + block * size.z), 0);
#ifdef GREY
    sum.r += dot(texel, lobe[block]);
#else
    sum += texel * lobe[block];
#endif
  }
  imageStore(sums, ivec3(place.xy, place.z + light * size.z), sum);
}

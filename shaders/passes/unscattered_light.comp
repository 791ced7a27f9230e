// Finds how the refracted light of each of a sample's suns comes through a prototype unscattered, at nodes, so that a walk need not look for it
// at every place where it scatters.
//
// What is chosen at compile time: as in models/unscattered.glsl.
#include "render/bindings.glsl"
#include "render/distant_light.glsl"
#include "models/unscattered.glsl"

const int GROUP = 64;  // nodes under one light
layout(local_size_x = GROUP) in;

layout(std430, binding = DISTANT_LIGHTS_BINDING) readonly buffer Lights { DistantLight lights[]; };

layout(rgba32f, binding = 0) writeonly uniform image3D found;

const float LEAST_COSINE = 0.1;

void main() {
  int light = int(gl_WorkGroupID.y);
  ivec3 size = FINER * ivec3(stored.last_node) + 1;
  int node = int(gl_WorkGroupID.x) * GROUP + int(gl_LocalInvocationIndex);
  if (node >= size.x * size.y * size.z) return;
  ivec3 at = ivec3(node % size.x, node / size.x % size.y, node / (size.x * size.y));
  vec3 spacing = 1.0 / stored.nodes_a_unit;
  vec3 place = stored.lower + vec3(at) * spacing / float(FINER);
  float above = distance_at(place);
  vec4 value = vec4(0.0);
  // Others are of no place inside.
  if (above < length(spacing)) {
    vec3 to_light = grain_to_body() * lights[light].to_light.xyz;
    vec3 inside = place - max(above, 0.0) * outwards_at(place);
    Unscattered unscattered = unscattered_at(inside, to_light);
    // Out here the way is what it would be were the surface a plane where the light came in, so that it is right where it comes to the surface.
    vec3 normal = outwards_where_light_enters(inside + unscattered.way * unscattered.back);
    float way = unscattered.way + dot(inside - place, normal) / max(dot(unscattered.back, normal), LEAST_COSINE);
    value = vec4(unscattered.irradiance * unscattered.back, way);
    // Pixels about it read it as well.
    if (any(isnan(value)) || any(isinf(value))) value = vec4(0.0);
  }
  imageStore(found, ivec3(at.xy, at.z + light * size.z), value);
}

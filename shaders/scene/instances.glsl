// Where the instances of a heap stand. They are drawn together, a transform each: from the mesh's own axes, the middle of its bounds at the
// origin, to the world's axes around a place amid the scene.
#include "render/bindings.glsl"

struct Placement {
  mat3 linear;
  vec3 place;  // of the middle
};

// Three rows of four numbers each.
layout(std430, binding = INSTANCES_BINDING) readonly buffer Instances { vec4 instance_rows[]; };

Placement placement_of(int instance) {
  vec4 x = instance_rows[3 * instance];
  vec4 y = instance_rows[3 * instance + 1];
  vec4 z = instance_rows[3 * instance + 2];
  return Placement(transpose(mat3(x.xyz, y.xyz, z.xyz)), vec3(x.w, y.w, z.w));
}

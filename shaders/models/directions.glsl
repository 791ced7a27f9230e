// Directions from others.
#include "physics/prelude.glsl"

vec3 perpendicular(vec3 direction) {
  return normalize(abs(direction.z) < 0.7 ? vec3(direction.y, -direction.x, 0.0) : vec3(0.0, direction.z, -direction.y));
}

// Of unit length, unless it has none: where normals of opposite sides meet.
vec3 unit_vector(vec3 v) { return v * inversesqrt(max(dot(v, v), 1e-20)); }

// Which way one prototype's surface lies, found beforehand at its nodes: it is asked for often.
#include "models/stored_grid.glsl"
#include "models/stored_products.glsl"

vec3 perpendicular(vec3 direction) {
  return normalize(abs(direction.z) < 0.7 ? vec3(direction.y, -direction.x, 0.0) : vec3(0.0, direction.z, -direction.y));
}

// Of unit length, unless it has none: where normals of opposite sides meet.
vec3 unit_vector(vec3 v) { return v * inversesqrt(max(dot(v, v), 1e-20)); }

#ifdef REFRACTION
uniform sampler3D slopes;  // of `distances`

// What outwards_at says, with edges rounded off over a node to either side instead of a half.
vec3 outwards_about(vec3 place) { return unit_vector(texture(slopes, (to_nodes(place) + 0.5) / (stored.last_node + 1.0)).xyz); }
#endif

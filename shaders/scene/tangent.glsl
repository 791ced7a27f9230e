// The direction in which a surface's u grows, kept beside its normal as two numbers.
#pragma once

// Two directions that are at right angles to the normal and each other, without a leap but at z = 0 (Duff et al., "Building an Orthonormal
// Basis, Revisited", 2017).
void basis_around(vec3 normal, out vec3 first, out vec3 second) {
  float side = normal.z >= 0.0 ? 1.0 : -1.0;
  float a = -1.0 / (side + normal.z);
  float b = normal.x * normal.y * a;
  first = vec3(1.0 + side * normal.x * normal.x * a, side * b, -side * normal.x);
  second = vec3(b, side + normal.y * normal.y * a, -normal.y);
}

// x: the angle from `first` to where u grows; y: 1 if v grows to its left seen from outside, -1 to its right, 0 where UVs say nothing.
// Places and UVs are told by how they change along any two ways on the surface.
vec2 packed_tangent(vec3 normal, vec3 place_a, vec3 place_b, vec2 uv_a, vec2 uv_b) {
  float area = uv_a.x * uv_b.y - uv_b.x * uv_a.y;
  if (area == 0.0) return vec2(0.0);
  vec3 along_u = (place_a * uv_b.y - place_b * uv_a.y) / area;
  vec3 along_v = (place_b * uv_a.x - place_a * uv_b.x) / area;
  vec3 first, second;
  basis_around(normal, first, second);
  return vec2(atan(dot(along_u, second), dot(along_u, first)), dot(cross(normal, along_u), along_v) < 0.0 ? -1.0 : 1.0);
}

// xyz: of unit length; w: as y above.
vec4 unpacked_tangent(vec3 normal, vec2 packed_one) {
  vec3 first, second;
  basis_around(normal, first, second);
  return vec4(cos(packed_one.x) * first + sin(packed_one.x) * second, packed_one.y);
}

// Numbers that differ from pixel to pixel and from sample to sample, to turn low-discrepancy points with.

uniform int sample_index;

// Four well mixed words from three (Jarzynski and Olano, "Hash Functions for GPU Rendering", JCGT 2020: pcg4d).
uvec4 pcg4d(uvec4 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  v ^= v >> 16u;
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  return v;
}

// Two coordinates of point `index` of the R2 sequence (Roberts 2018) from `offset`, exact for any index.
vec2 low_discrepancy(uint index, uvec2 offset) {
  uvec2 bits = uvec2(3242174889u, 2447445414u) * index + offset;
  return vec2(bits >> 8u) * (1.0 / 16777216.0);
}

// The same of dimensions 3 and 4 of the sequence in four dimensions, which go together with r2_point, the place within the pixel
// (native/render/sequence.h), without correlation.
vec2 low_discrepancy_beside_pixel(uint index, uvec2 offset) {
  uvec2 bits = uvec2(2700274806u, 2313257605u) * index + offset;
  return vec2(bits >> 8u) * (1.0 / 16777216.0);
}

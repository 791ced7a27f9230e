// How much of its light a spot sends in a direction.
#pragma once

// The cone's frame has its axis as the third vector and its cross-section's as the others, so that an elliptical cone is round in it.
// cosine_edge: of half the cone's angle; sharpness: 1 / the width of the soft edge, in cosines. Cycles' smoothstep.
pure real cone_share(real3 away, real3 narrow_x, real3 narrow_y, real3 axis, real cosine_edge, real sharpness, bool weakens) {
  real3 local = real3(dot(away, narrow_x), dot(away, narrow_y), dot(away, axis));
  real cosine = local.z / max(sqrt(dot(local, local)), 1e-18);
  real t = clamp((cosine - cosine_edge) * sharpness, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t) * (weakens ? max(cosine, 0.0) : 1.0);
}

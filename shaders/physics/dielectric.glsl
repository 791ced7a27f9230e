// Light that a dielectric surface reflects: GGX microfacets, each of them a Fresnel mirror.
#pragma once
#include "physics/fresnel.glsl"
#include "physics/ggx.glsl"

// The width of the highlight under a sun whose disc measures `angle` radians from edge to edge, as a GGX alpha. The
// renderer draws directions from the disc, which is half as wide in half vectors; a lobe of half the disc's radius
// there joins the few directions of a picture into one. Never above what the surface has by more than that.
pure real dielectric_alpha(real roughness, real angle) { return max(roughness, 0.125 * angle); }

// The BRDF, per steradian (Walter et al. 2007 eq. 20; masking and shadowing as ggx.glsl has them): F(w.h) D(h) G2 / (4 mu_i mu_o).
// Both cosines are positive. The half angle's cosine is half the length of the sum of the directions, which does not cancel.
pure real dielectric_reflection(real3 normal, real3 w_i, real mu_i, real3 w_o, real mu_o, real eta, real alpha, bool correlated) {
  real3 sum = w_i + w_o;
  real size = sqrt(max(dot(sum, sum), 1e-30));
  real visibility = correlated ? ggx_visibility_correlated(mu_i, mu_o, alpha) : ggx_visibility_separable(mu_i, mu_o, alpha);
  return fresnel_reflectance(min(0.5 * size, 1.0), eta) * ggx_distribution(normal, sum / size, alpha) * visibility;
}

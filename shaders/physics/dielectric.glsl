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

// What one facet that is seen at the cosine mu_o, `on_facet` to its own normal, lets through: light that it mirrors towards mu_i and that meets
// no other is not (G2 over the viewer's G1: Heitz 2014 eqs. 43 and 99). The mean over the facets seen is what dielectric_reflection leaves.
pure real dielectric_facet_passed(real on_facet, real mu_i, real mu_o, real eta, real alpha, bool correlated) {
  if (mu_i <= 0.0) return 1.0;
  real visibility = correlated ? ggx_visibility_correlated(mu_i, mu_o, alpha) : ggx_visibility_separable(mu_i, mu_o, alpha);
  return 1.0 - fresnel_reflectance(on_facet, eta) * 2.0 * visibility * mu_i * (mu_o + ggx_smith_root(mu_o, alpha));
}

// Where light goes on inside that comes in through a facet, `on_facet` the cosine to its normal outside. What would stay outside meets others.
pure real3 refracted_by_facet(real3 normal, real3 facet, real3 to_light, real on_facet, real eta) {
  real3 inwards = (on_facet * facet - to_light) / eta - refracted_cosine(on_facet, eta) * facet;
  return normalize(inwards - 2.0 * max(dot(inwards, normal), 0.0) * normal);
}

// What stays inside of light that meets a facet there, mu_beyond the cosine at which the rest would leave. Of what other facets shadow (Walter et
// al. 2007 eq. 34) half comes in again, less where they hardly refract: over all directions as much leaves then as enters, within 1.5 % up to an
// alpha of 0.5 and an eta of 1.8.
pure real dielectric_facet_kept(real on_facet, real mu_beyond, real eta, real alpha) {
  real unshadowed = mu_beyond > 0.0 ? 2.0 * mu_beyond / (mu_beyond + ggx_smith_root(mu_beyond, alpha)) : 0.0;
  real comes_in = min(0.5, sqrt(eta - 1.0));
  return 1.0 - (1.0 - fresnel_reflectance(on_facet, 1.0 / eta)) * (1.0 - comes_in * (1.0 - unshadowed));
}

// Where light goes on that stays inside.
pure real3 reflected_by_facet(real3 normal, real3 facet, real3 direction) {
  real3 inwards = direction - 2.0 * dot(facet, direction) * facet;
  return normalize(inwards - 2.0 * max(dot(inwards, normal), 0.0) * normal);
}

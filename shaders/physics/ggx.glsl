// The GGX microfacet distribution and Smith's masking and shadowing, in forms that single precision can bear.
#pragma once

// Below this the highlight is narrower than a single-precision half vector can resolve; alpha = 0 is drawn as this.
const real GGX_SMALLEST_ALPHA = 1e-3;

// D(h), per steradian (Trowbridge & Reitz 1975; Walter et al. 2007 eq. 33). s2 = |n x h|^2 is taken from the cross product because
// (n.h)^2 (alpha^2 - 1) + 1 loses every digit for alpha < 1e-3.
pure real ggx_distribution(real3 normal, real3 half_vector, real alpha) {
  real3 sine = cross(normal, half_vector);
  real s2 = min(dot(sine, sine), 1.0);
  real a2 = alpha * alpha;
  real d = a2 * (1.0 - s2) + s2;
  return a2 / (PI * d * d);
}

// sqrt(alpha^2 + (1 - alpha^2) mu^2), the root in Smith's Lambda (Walter et al. 2007 eq. 34).
pure real ggx_smith_root(real mu, real alpha) { return sqrt(alpha * alpha + (1.0 - alpha) * (1.0 + alpha) * mu * mu); }

// G2 / (4 mu_i mu_o) with height-correlated masking and shadowing (Heitz 2014 eq. 99); finite at grazing.
pure real ggx_visibility_correlated(real mu_i, real mu_o, real alpha) {
  return 0.5 / max(mu_i * ggx_smith_root(mu_o, alpha) + mu_o * ggx_smith_root(mu_i, alpha), 1e-18);
}

// Of directions mirrored in the facets that a viewer at the cosine mu_o sees, per steradian: G1(o) D(h) / (4 mu_o) (Heitz, "Sampling the GGX
// Distribution of Visible Normals", JCGT 2018, equations 3 and 17).
pure real ggx_mirrored_density(real distribution, real mu_o, real alpha) { return 0.5 * distribution / (mu_o + ggx_smith_root(mu_o, alpha)); }

// G1(i) G1(o) / (4 mu_i mu_o), masking and shadowing taken as independent (Walter et al. 2007 eq. 23).
pure real ggx_visibility_separable(real mu_i, real mu_o, real alpha) {
  return 1.0 / ((mu_i + ggx_smith_root(mu_i, alpha)) * (mu_o + ggx_smith_root(mu_o, alpha)));
}

// The normal of a facet that a viewer sees, drawn by how much of what is seen such facets are; `random` is in [0, 1)^2 (Dupuy and Benyoub,
// "Sampling Visible GGX Normals with Spherical Caps", 2023, listing 3).
pure real3 ggx_visible_facet(real3 normal, real3 to_viewer, real alpha, real2 random) {
  real side = normal.z >= 0.0 ? 1.0 : -1.0;
  real a = -1.0 / (side + normal.z);
  real b = normal.x * normal.y * a;
  real3 x = real3(1.0 + side * normal.x * normal.x * a, side * b, -side * normal.x);
  real3 y = real3(b, side + normal.y * normal.y * a, -normal.y);
  real3 wide = normalize(real3(alpha * dot(x, to_viewer), alpha * dot(y, to_viewer), dot(normal, to_viewer)));
  real azimuth = 2.0 * PI * random.x;
  real height = (1.0 - random.y) * (1.0 + wide.z) - wide.z;
  real across = sqrt(clamp((1.0 - height) * (1.0 + height), 0.0, 1.0));
  real3 facet = real3(across * cos(azimuth), across * sin(azimuth), height) + wide;
  return normalize(alpha * facet.x * x + alpha * facet.y * y + max(facet.z, 1e-7) * normal);
}

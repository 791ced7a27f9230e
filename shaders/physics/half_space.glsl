// Light that a half-space of scattering medium sends back, as a BRDF: the geometry of refraction and the term every order shares.
#pragma once

// (1 -+ cosine) for the Henyey-Greenstein function inside the medium, for outward directions w_i and w_o above the surface whose
// refracted cosines are given; `sign_g` is +1 or -1. The scattering angle lies between -w_i' and w_o' (Hanrahan & Krueger 1993, section 5),
// so 1 - cos = |w_i' + w_o'|^2 / 2 and 1 + cos = |w_i' - w_o'|^2 / 2, and the tangential parts are those above the surface over eta.
pure real refracted_versine(real3 w_i, real mu_i, real mu_i_refracted, real3 w_o, real mu_o, real mu_o_refracted, real3 normal,
                            real inverse_eta_squared, real sign_g) {
  real3 tangential = (w_i - mu_i * normal) + sign_g * (w_o - mu_o * normal);
  real axial = mu_i_refracted + sign_g * mu_o_refracted;
  return 0.5 * (dot(tangential, tangential) * inverse_eta_squared + axial * axial);
}

// The factor in front of every order of scattering (Hanrahan & Krueger 1993 eq. 5 and Chandrasekhar 1960 section 39 for the
// 1/(mu + mu_0); radiance that leaves a medium of index eta spreads by 1/eta^2): single scattering is this times albedo * p.
// `transmittance` is the product of both passages.
pure real half_space_factor(real mu_i_refracted, real mu_o_refracted, real transmittance, real inverse_eta_squared) {
  return transmittance * inverse_eta_squared / max(mu_i_refracted + mu_o_refracted, 1e-9);
}

// Where the multiple-scattering table is looked up: the grazing end, where the medium answers like mu log(mu), is stretched.
pure real half_space_coordinate(real mu, real mu_refracted) { return sqrt(min(mu, mu_refracted)); }

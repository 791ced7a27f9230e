// A smooth dielectric interface: refraction and what passes through. eta is the index on the far side over that on the near side.
#pragma once

// Cosine of the refracted direction, 0 under total internal reflection (Snell; Born & Wolf, section 1.5.1).
// Written as (mu^2 + eta^2 - 1) / eta^2: nothing cancels for eta >= 1.
pure real refracted_cosine(real mu, real eta) { return sqrt(max(0.0, mu * mu + (eta - 1.0) * (eta + 1.0))) / eta; }

// The fraction of unpolarised flux that passes, given the cosine and its refracted partner (Born & Wolf eq. 1.5.42; Walter et al. 2007
// eq. 22), as the mean of 1 - r_s^2 = 4 eta mu mu_t/(mu + eta mu_t)^2 and 1 - r_p^2: no difference of nearly equal numbers, 0 at grazing.
pure real fresnel_transmittance(real mu, real mu_refracted, real eta) {
  real s = 1.0 / max(mu + eta * mu_refracted, 1e-18);
  real p = 1.0 / max(eta * mu + mu_refracted, 1e-18);
  return 2.0 * eta * ((mu * s) * (mu_refracted * s) + (mu * p) * (mu_refracted * p));
}

// The fraction of unpolarised flux that is reflected; 1 under total internal reflection.
pure real fresnel_reflectance(real mu, real eta) {
  real refracted = sqrt(max(0.0, mu * mu + (eta - 1.0) * (eta + 1.0)));  // eta times the refracted cosine
  real s = (mu - refracted) / max(mu + refracted, 1e-18);
  real p = (eta * eta * mu - refracted) / max(eta * eta * mu + refracted, 1e-18);
  return mu <= 0.0 ? 1.0 : 0.5 * (s * s + p * p);
}

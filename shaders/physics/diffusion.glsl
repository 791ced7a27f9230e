// Total diffuse reflectances of a half-space in closed form. 1 - alpha' comes in as sigma_a/sigma_t', never as a difference.
#pragma once
#include "physics/elementary.glsl"

// exp(-k d_r)/d_r - exp(-k d_v)/d_v: the fluence of a source and its negative image (Jensen et al. 2001 eq. 3, without its factors) at
// distances d_r < d_v, which far away agree in every digit. `delta_squared` is d_v^2 - d_r^2, known by itself; no difference is taken.
pure real image_difference(real real_distance, real virtual_distance, real delta_squared, real decay) {
  real delta = delta_squared / (real_distance + virtual_distance);
  return exp(-decay * real_distance) / real_distance * ((delta - real_distance * expm1(-decay * delta)) / virtual_distance);
}

// Jensen et al. 2001, the integral of their eq. 4 over the plane (their section 4.3 table). `boundary` is A = (1 + F_dr)/(1 - F_dr).
pure real dipole_total(real one_minus_reduced_albedo, real boundary) {
  real reduced_albedo = 1.0 - one_minus_reduced_albedo;
  real s = sqrt(3.0 * one_minus_reduced_albedo);
  return 0.5 * reduced_albedo * exp(-s) * (1.0 + exp(-4.0 / 3.0 * boundary * s));
}

// The better dipole (d'Eon 2012; Grosjean's diffusion coefficient, boundary and exitance constants of d'Eon & Irving 2011 eqs. 15 to 18),
// scattering orders from two up. With lengths in units of 1/sigma_t': D = (1 + (1 - alpha'))/3, z_b = 2 A D, and the difference
// exp(-s z_r) - exp(-s (z_r + 2 z_b)) over 2 D s in the form that has a limit for s -> 0.
pure real better_dipole_total(real one_minus_reduced_albedo, real boundary, real c_phi, real c_e) {
  real reduced_albedo = 1.0 - one_minus_reduced_albedo;
  real diffusion = (1.0 + one_minus_reduced_albedo) / 3.0;
  real s = sqrt(one_minus_reduced_albedo / diffusion);
  real x = 4.0 * boundary * diffusion * s;
  real fluence = 2.0 * boundary * mean_attenuation(x);
  real flux = 0.5 * (1.0 + exp(-x));
  return reduced_albedo * reduced_albedo * exp(-s) * (c_phi * fluence + c_e * flux);
}

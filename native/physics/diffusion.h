// The diffusion equation's half-space in closed form. 1 - alpha' comes in as sigma_a/sigma_t', never as a difference.
#pragma once

namespace mesograin::physics {

/// exp(-k d_r)/d_r - exp(-k d_v)/d_v: the fluence of a source and its negative image (Jensen et al. 2001 eq. 3, without
/// its factors) at distances d_r < d_v, which far away agree in every digit. `delta_squared` is d_v^2 - d_r^2, known by
/// itself; no difference is taken.
double image_difference(double real_distance, double virtual_distance, double delta_squared, double decay);

/// Jensen et al. 2001, the integral of their eq. 4 over the plane (their section 4.3 table): the total diffuse
/// reflectance. `boundary` is A = (1 + F_dr)/(1 - F_dr).
double dipole_total(double one_minus_reduced_albedo, double boundary);

/// The same of the better dipole (d'Eon 2012; Grosjean's diffusion coefficient, boundary and exitance constants of
/// d'Eon & Irving 2011 eqs. 15 to 18), scattering orders from two up.
double better_dipole_total(double one_minus_reduced_albedo, double boundary, double c_phi, double c_e);

}  // namespace mesograin::physics

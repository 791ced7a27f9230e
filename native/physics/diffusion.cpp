// Differences of exponentials in forms that have a limit where they would cancel.
#include "physics/diffusion.h"

#include <cmath>

#include "physics/physics.h"

namespace mesograin::physics {

double image_difference(double real_distance, double virtual_distance, double delta_squared, double decay) {
  const double delta = delta_squared / (real_distance + virtual_distance);
  return std::exp(-decay * real_distance) / real_distance *
         ((delta - real_distance * std::expm1(-decay * delta)) / virtual_distance);
}

double dipole_total(double one_minus_reduced_albedo, double boundary) {
  const double reduced_albedo = 1.0 - one_minus_reduced_albedo;
  const double s = std::sqrt(3.0 * one_minus_reduced_albedo);
  return 0.5 * reduced_albedo * std::exp(-s) * (1.0 + std::exp(-4.0 / 3.0 * boundary * s));
}

// With lengths in units of 1/sigma_t': D = (1 + (1 - alpha'))/3, z_b = 2 A D, and exp(-s z_r) - exp(-s (z_r + 2 z_b))
// over 2 D s.
double better_dipole_total(double one_minus_reduced_albedo, double boundary, double c_phi, double c_e) {
  const double reduced_albedo = 1.0 - one_minus_reduced_albedo;
  const double diffusion = (1.0 + one_minus_reduced_albedo) / 3.0;
  const double s = std::sqrt(one_minus_reduced_albedo / diffusion);
  const double x = 4.0 * boundary * diffusion * s;
  const double fluence = 2.0 * boundary * mean_attenuation(x);
  const double flux = 0.5 * (1.0 + std::exp(-x));
  return reduced_albedo * reduced_albedo * std::exp(-s) * (c_phi * fluence + c_e * flux);
}

}  // namespace mesograin::physics

// The published half-space profiles, in forms without cancellation.
#include "physics/kernels/planar_kernel.h"

#include <array>
#include <cmath>

#include "physics/diffusion.h"
#include "physics/physics.h"

namespace mesograin::physics {
namespace {

constexpr int beam_depths = 100;

// In mean free paths, each standing for as much of the beam's light.
const std::array<double, beam_depths>& beam_optical_depths() {
  static const std::array<double, beam_depths> depths = [] {
    std::array<double, beam_depths> values{};
    for (int i = 0; i < beam_depths; ++i) values[i] = -std::log1p(-(i + 0.5) / beam_depths);
    return values;
  }();
  return depths;
}

// No length here is so long or short that its square leaves the range of double.
double hypotenuse(double a, double b) { return std::sqrt(a * a + b * b); }

double flux_term(double depth, double distance, double decay) {
  return depth * (1.0 + decay * distance) * std::exp(-decay * distance) / (distance * distance * distance);
}

struct GrosjeanDiffusion {
  double diffusion;
  double decay;
  double boundary;  // 2 z_b
};

GrosjeanDiffusion grosjean(const BodyMedium& medium, const BodySurface& surface) {
  const double sigma_t = medium.reduced_sigma_t();
  const double diffusion = (medium.sigma_a + sigma_t) / (3.0 * sigma_t * sigma_t);
  return {diffusion, std::sqrt(medium.sigma_a / diffusion), 4.0 * surface.diffusion.a * diffusion};
}

// C_phi phi + C_E E_n of a dipole at depth z (d'Eon & Irving 2011 eq. 14; pbrt-v4 BeamDiffusionMS).
double dipole_exitance(const GrosjeanDiffusion& medium, const BodySurface& surface, double depth, double distance) {
  const double image = depth + medium.boundary;
  const double real_distance = hypotenuse(distance, depth);
  const double virtual_distance = hypotenuse(distance, image);
  const double fluence =
      image_difference(real_distance, virtual_distance, medium.boundary * (depth + image), medium.decay) /
      (4.0 * PI * medium.diffusion);
  const double flux =
      (flux_term(depth, real_distance, medium.decay) + flux_term(image, virtual_distance, medium.decay)) / (4.0 * PI);
  return surface.diffusion.c_phi * fluence + surface.diffusion.c_e * flux;
}

}  // namespace

PlanarKernel::PlanarKernel(PlanarProfile profile, const BodyMedium& medium, const BodySurface& surface, double total)
    : profile_(profile), medium_(medium), surface_(surface) {
  if (total > 0.0 && medium.reduced_sigma_s() > 0.0) scale_ = total / this->total();
}

double PlanarKernel::radiant_exitance(double distance) const {
  const double sigma_t = medium_.reduced_sigma_t();
  const double albedo = medium_.reduced_sigma_s() / sigma_t;
  if (profile_ == PlanarProfile::dipole) {
    const double decay = std::sqrt(3.0 * medium_.sigma_a * sigma_t);
    const double depth = 1.0 / sigma_t;
    const double image = depth * (1.0 + 4.0 / 3.0 * surface_.diffusion.a);
    return albedo / (4.0 * PI) *
           (flux_term(depth, hypotenuse(distance, depth), decay) +
            flux_term(image, hypotenuse(distance, image), decay));
  }
  const GrosjeanDiffusion medium = grosjean(medium_, surface_);
  if (profile_ == PlanarProfile::better_dipole)
    return albedo * albedo * dipole_exitance(medium, surface_, 1.0 / sigma_t, distance);
  double sum = 0.0;
  for (const double optical_depth : beam_optical_depths()) {
    const double depth = optical_depth / sigma_t;
    // The empirical near-source correction of Habel et al. 2013 (their section 5.1).
    const double correction = -std::expm1(-2.0 * sigma_t * (hypotenuse(distance, depth) + depth));
    sum += correction * dipole_exitance(medium, surface_, depth, distance);
  }
  return albedo * albedo * sum / beam_depths;
}

std::vector<double> PlanarKernel::evaluate(const std::vector<double>& distances, double) const {
  std::vector<double> values(distances.size(), 0.0);
  if (medium_.reduced_sigma_s() <= 0.0) return values;
  for (std::size_t i = 0; i < distances.size(); ++i) values[i] = scale_ * radiant_exitance(distances[i]);
  return values;
}

double PlanarKernel::total() const {
  if (medium_.reduced_sigma_s() <= 0.0) return 0.0;
  const double sigma_t = medium_.reduced_sigma_t();
  const double one_minus_albedo = medium_.sigma_a / sigma_t;
  const DiffusionBoundary& boundary = surface_.diffusion;
  if (profile_ == PlanarProfile::dipole) return scale_ * dipole_total(one_minus_albedo, boundary.a);
  if (profile_ == PlanarProfile::better_dipole)
    return scale_ * better_dipole_total(one_minus_albedo, boundary.a, boundary.c_phi, boundary.c_e);
  // 2 pi int R r dr over r = e^u, in which the profile is smooth and both its ends vanish: few steps are exact.
  constexpr int steps = 100;
  const double lowest = std::log(1e-4 / sigma_t);
  const double highest =
      std::log(60.0 / std::min(sigma_t, std::max(grosjean(medium_, surface_).decay, 1e-3 * sigma_t)));
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double r = std::exp(lowest + (highest - lowest) * (i + 0.5) / steps);
    sum += 2.0 * PI * r * r * radiant_exitance(r);
  }
  return scale_ * sum * (highest - lowest) / steps;
}

}  // namespace mesograin::physics

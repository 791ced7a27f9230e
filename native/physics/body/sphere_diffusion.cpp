// Ratios of neighbouring orders only: the Bessel functions themselves leave the range of double.
#include "physics/body/sphere_diffusion.h"

#include <algorithm>
#include <cmath>

#include "physics/physics.h"

namespace mesograin::physics {
namespace {

// Below this a decay is indistinguishable from none: the ratios are linear in it to 1e-12.
constexpr double least_decay = 1e-5;

// i_{l+1}(x)/i_l(x)/x for l = 0, 1, ..., by the continued fraction of the recurrence i_{l-1} = i_{l+1} + (2l+1)/x i_l
// (Abramowitz & Stegun 10.2.18), run downwards from a value between the bounds of Amos 1974 (eqs. 9 and 11).
void neighbour_ratios(double x, std::vector<double>& ratios) {
  constexpr int run_up = 24;
  const int count = static_cast<int>(ratios.size());
  const double start = count + run_up;
  const double x2 = x * x;
  double ratio = 1.0 / (start + 1.0 + std::sqrt((start + 1.5) * (start + 1.5) + x2));
  for (int l = count + run_up; l > 0; --l) {
    ratio = 1.0 / (2.0 * l + 1.0 + x2 * ratio);
    if (l <= count) ratios[l - 1] = ratio;
  }
}

}  // namespace

SphereDiffusion::SphereDiffusion(double decay, double boundary_length, int largest_order)
    : decay_(std::max(decay, least_decay)),
      ratios_(largest_order + 1),
      boundary_(largest_order + 1),
      scratch_(largest_order + 1) {
  neighbour_ratios(decay_, ratios_);
  for (int l = 0; l <= largest_order; ++l) {
    const double logarithmic_derivative = l + decay_ * decay_ * ratios_[l];
    boundary_[l] = 1.0 / (1.0 + boundary_length * logarithmic_derivative);
  }
}

void SphereDiffusion::transfer(double r, std::vector<double>& transfer) const {
  const double x = decay_ * r;
  neighbour_ratios(x, scratch_);
  // i_0 = sinh(x)/x, without its growth.
  double order = std::exp(x - decay_) * mean_attenuation(2.0 * x) / mean_attenuation(2.0 * decay_);
  for (std::size_t l = 0; l < boundary_.size(); ++l) {
    transfer[l] = order * boundary_[l];
    order *= r * scratch_[l] / ratios_[l];
  }
}

}  // namespace mesograin::physics

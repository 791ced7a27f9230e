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
void neighbour_ratios(const SideBySide& x, std::vector<SideBySide>& ratios) {
  constexpr int run_up = 24;
  const int count = static_cast<int>(ratios.size());
  const double start = count + run_up;
  SideBySide square;
  SideBySide ratio;
  for (std::size_t i = 0; i < side_by_side; ++i) {
    square[i] = x[i] * x[i];
    ratio[i] = 1.0 / (start + 1.0 + std::sqrt((start + 1.5) * (start + 1.5) + square[i]));
  }
  for (int l = count + run_up; l > 0; --l) {
    for (std::size_t i = 0; i < side_by_side; ++i) ratio[i] = 1.0 / (2.0 * l + 1.0 + square[i] * ratio[i]);
    if (l <= count) ratios[l - 1] = ratio;
  }
}

}  // namespace

SphereDiffusion::SphereDiffusion(double decay, double boundary_length, int largest_order)
    : decay_(std::max(decay, least_decay)),
      ratios_(largest_order + 1),
      boundary_(largest_order + 1),
      scratch_(largest_order + 1) {
  SideBySide at_surface;
  at_surface.fill(decay_);
  neighbour_ratios(at_surface, scratch_);
  for (int l = 0; l <= largest_order; ++l) ratios_[l] = scratch_[l][0];
  for (int l = 0; l <= largest_order; ++l) {
    const double logarithmic_derivative = l + decay_ * decay_ * ratios_[l];
    boundary_[l] = 1.0 / (1.0 + boundary_length * logarithmic_derivative);
  }
}

void SphereDiffusion::transfer(const SideBySide& r, std::vector<SideBySide>& transfer) const {
  SideBySide order;
  SideBySide x;
  for (std::size_t i = 0; i < side_by_side; ++i) {
    x[i] = decay_ * r[i];
    // i_0 = sinh(x)/x, without its growth.
    order[i] = std::exp(x[i] - decay_) * mean_attenuation(2.0 * x[i]) / mean_attenuation(2.0 * decay_);
  }
  neighbour_ratios(x, scratch_);
  for (std::size_t l = 0; l < boundary_.size(); ++l) {
    const double farther = 1.0 / ratios_[l];
    for (std::size_t i = 0; i < side_by_side; ++i) {
      transfer[l][i] = order[i] * boundary_[l];
      order[i] *= r[i] * scratch_[l][i] * farther;
    }
  }
}

}  // namespace mesograin::physics

// The delta scaling of Joseph, Wiscombe & Weinman, with the first scattering kept as it is (after Nakajima & Tanaka
// 1988, section 3, who keep it on both ways: here the peak's own light is counted once).
#include "physics/half_space/marched_light.h"

#include <algorithm>
#include <cmath>

#include "physics/forward_peak.h"
#include "physics/legendre.h"
#include "physics/physics.h"

namespace mesograin::physics {
namespace {

constexpr int legendre_count = 100;

std::vector<std::vector<double>> legendre_of(const std::vector<double>& mu) {
  std::vector<std::vector<double>> values(mu.size(), std::vector<double>(legendre_count));
  for (std::size_t i = 0; i < mu.size(); ++i) legendre_polynomials(mu[i], values[i]);
  return values;
}

// The azimuthally averaged phase function between a direction down and one up.
double average_phase(double g, const std::vector<double>& down, const std::vector<double>& up) {
  double sum = 0.0;
  double power = 1.0;
  for (int l = 0; l < legendre_count && power != 0.0; ++l, power *= -g) sum += (2 * l + 1) * power * down[l] * up[l];
  return std::max(sum, 0.0) / (4.0 * PI);
}

}  // namespace

std::vector<double> marched_in_half_space(const Medium& medium, double phase_g, const std::vector<double>& mu_in,
                                          const std::vector<double>& mu_out) {
  const ForwardPeak peak(medium.g);
  const std::vector<std::vector<double>> down = legendre_of(mu_in);
  const std::vector<std::vector<double>> up = legendre_of(mu_out);
  // Extinction where the peak counts as none, over extinction.
  const double past_peak = medium.one_minus_albedo + medium.albedo * peak.rest;
  std::vector<double> table;
  table.reserve(mu_in.size() * mu_out.size());
  for (std::size_t out = 0; out < mu_out.size(); ++out)
    for (std::size_t in = 0; in < mu_in.size(); ++in) {
      const double first = (mu_in[in] + mu_out[out]) / std::max(mu_out[out] + past_peak * mu_in[in], 1e-300);
      double sum = first * average_phase(phase_g, down[in], up[out]);
      if (peak.share > 0.0)
        sum += peak.rest * (1.0 / past_peak - first) * average_phase(ForwardPeak(phase_g).rest_g, down[in], up[out]);
      table.push_back(medium.albedo * sum);
    }
  return table;
}

}  // namespace mesograin::physics

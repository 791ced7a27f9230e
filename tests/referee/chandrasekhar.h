// Chandrasekhar's H function: the exact albedo of an index-matched, isotropically scattering half-space.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace mesograin::referee {

/// Solves 1/H(mu) = sqrt(1-albedo) + albedo/2 int_0^1 mu' H(mu') / (mu + mu') dmu' by iteration ("Radiative transfer",
/// 1950, chapter V); integrals by the midpoint rule in the square root of mu, which tames the logarithm at mu = 0.
class ChandrasekharH {
 public:
  explicit ChandrasekharH(double albedo) : albedo_(albedo), values_(nodes, 1.0) {
    std::vector<double> mu(nodes), weight(nodes);
    for (int i = 0; i < nodes; ++i) {
      const double root = (i + 0.5) / nodes;
      mu[i] = root * root;
      weight[i] = 2 * root / nodes;
    }
    mu_ = mu, weight_ = weight;
    for (double change = 1; change > 1e-12;) {
      change = 0;
      for (int i = 0; i < nodes; ++i) {
        const double next = 0.5 * (values_[i] + value(mu[i]));
        change = std::max(change, std::abs(next - values_[i]));
        values_[i] = next;
      }
    }
  }

  double value(double mu) const {
    double integral = 0;
    for (int i = 0; i < nodes; ++i) integral += weight_[i] * mu_[i] * values_[i] / (mu + mu_[i]);
    return 1 / (std::sqrt(1 - albedo_) + albedo_ / 2 * integral);
  }

  /// Reflected over incident flux of a beam at cosine mu.
  double plane_albedo(double mu) const { return 1 - std::sqrt(1 - albedo_) * value(mu); }

  /// The same for cosine-weighted incidence.
  double spherical_albedo() const {
    double sum = 0;
    for (int i = 0; i < nodes; ++i) sum += 2 * weight_[i] * mu_[i] * plane_albedo(mu_[i]);
    return sum;
  }

 private:
  static constexpr int nodes = 200;
  double albedo_;
  std::vector<double> mu_, weight_, values_;
};

}  // namespace mesograin::referee

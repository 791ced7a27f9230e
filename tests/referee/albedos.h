// Many albedos from one conservative walk: a photon that left after n scatterings carries albedo^n.
#pragma once

#include <cmath>
#include <span>
#include <vector>

namespace mesograin::referee {

class AlbedoPowers {
 public:
  explicit AlbedoPowers(std::span<const double> albedos) : albedos_(albedos.begin(), albedos.end()) {
    powers_.resize(tabulated_orders * albedos_.size());
    for (std::size_t a = 0; a < albedos_.size(); ++a)
      for (int order = 0; order < tabulated_orders; ++order)
        powers_[order * albedos_.size() + a] = std::pow(albedos_[a], order);
  }

  std::size_t count() const { return albedos_.size(); }

  /// sums[a] += weight * albedos[a]^order
  void add(double weight, int order, double* sums) const {
    const std::size_t count = albedos_.size();
    if (order < tabulated_orders) {
      const double* powers = &powers_[order * count];
      for (std::size_t a = 0; a < count; ++a) sums[a] += weight * powers[a];
    } else {
      for (std::size_t a = 0; a < count; ++a) sums[a] += weight * std::pow(albedos_[a], order);
    }
  }

 private:
  static constexpr int tabulated_orders = 4096;
  std::vector<double> albedos_;
  std::vector<double> powers_;
};

}  // namespace mesograin::referee

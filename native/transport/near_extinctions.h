// Walks are traced at a few extinctions, a ladder of them, and answer for all between its steps: what decays along ways
// of many lengths is known at three extinctions and is exp(polynomial) in between.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace mesograin::transport {

inline constexpr std::size_t near_extinctions = 3;
inline constexpr std::size_t near_middle = 1;

/// From a step of the ladder to the next.
inline constexpr double extinction_step = 1.5;

/// Below the lowest step, per unit of the body, next to nothing is scattered.
inline constexpr double least_extinction = 0.01;

/// The ladder's step that answers for `sigma_t`, within the square root of a step.
inline double nearest_step(double sigma_t) {
  const double steps = std::round(std::log(std::max(sigma_t, least_extinction)) / std::log(extinction_step));
  return std::pow(extinction_step, steps);
}

/// Where what decays is known around an extinction: half a step below, at it, half a step above.
inline std::array<float, near_extinctions> extinctions_near(double sigma_t) {
  const double half = std::sqrt(extinction_step);
  return {static_cast<float>(sigma_t / half), static_cast<float>(sigma_t), static_cast<float>(sigma_t * half)};
}

/// A logarithm as a whole number, to a thousandth; 0 for nothing.
using Logarithm = std::uint16_t;

/// Of what decays; what is less than exp(-60) counts as nothing.
inline Logarithm known_logarithm(float value) {
  return static_cast<Logarithm>(std::clamp(1e3F * (std::log(std::max(value, 1e-30F)) + 60.0F), 0.0F, 65535.0F));
}

/// Lagrange's weights of the logarithms at `extinctions_near(traced)`.
class NearWeights {
 public:
  NearWeights(double traced, double sigma_t) {
    const std::array<float, near_extinctions> near = extinctions_near(traced);
    for (std::size_t i = 0; i < near_extinctions; ++i) {
      double weight = 1.0;
      for (std::size_t j = 0; j < near_extinctions; ++j)
        if (j != i) weight *= (sigma_t - near[j]) / (near[i] - near[j]);
      weights_[i] = static_cast<float>(weight);
    }
  }

  /// `logarithms` as `known_logarithm` gives them.
  float decayed(const Logarithm* logarithms) const {
    if (logarithms[0] == 0) return 0.0F;
    float logarithm = -60.0F + 0.5e-3F;  // they were rounded down
    for (std::size_t i = 0; i < near_extinctions; ++i)
      logarithm += 1e-3F * weights_[i] * static_cast<float>(logarithms[i]);
    return std::exp(logarithm);
  }

  /// Of one logarithm after the other, into a row of Eigen's.
  template <typename Row>
  void decayed(const Logarithm* logarithms, Row& row) const {
    for (Eigen::Index i = 0; i < row.size(); ++i, logarithms += near_extinctions) {
      float logarithm = -60.0F + 0.5e-3F;
      for (std::size_t e = 0; e < near_extinctions; ++e)
        logarithm += 1e-3F * weights_[e] * static_cast<float>(logarithms[e]);
      row[i] = logarithms[0] == 0 ? least : logarithm;
    }
    row = (row.array() > least).select(row.array().exp(), 0.0F).matrix();
  }

 private:
  static constexpr float least = -80.0F;  // nothing, whose exponential is a number that is not slow

  std::array<float, near_extinctions> weights_{};
};

}  // namespace mesograin::transport

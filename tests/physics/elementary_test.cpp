// The elementary functions in double against the C library's.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/physics.h"

namespace mesograin::physics {
namespace {

// Arguments of both signs from 1e-18 to `largest`, evenly spread in the logarithm.
template <typename Visit>
void for_magnitudes(double largest, Visit visit) {
  for (double magnitude = 1e-18; magnitude <= largest; magnitude *= 1.13) {
    visit(magnitude);
    visit(-magnitude);
  }
}

TEST(Elementary, Expm1HoldsNearZero) {
  for_magnitudes(80.0, [](double x) { EXPECT_NEAR(expm1(x) / std::expm1(x), 1.0, 1e-14) << x; });
  EXPECT_EQ(expm1(0.0), 0.0);
}

TEST(Elementary, MeanAttenuationHasItsLimit) {
  EXPECT_EQ(mean_attenuation(0.0), 1.0);
  for (double x = 1e-15; x < 700.0; x *= 1.5) EXPECT_NEAR(mean_attenuation(x) * x / -std::expm1(-x), 1.0, 1e-11) << x;
}

TEST(Elementary, MeanCrossingIsItsIntegral) {
  for (double x = 1e-3; x < 100.0; x *= 1.7) {
    constexpr int steps = 20000;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
      const double mu = (i + 0.5) / steps;
      sum += 2.0 * mu * std::exp(-x * mu) / steps;
    }
    EXPECT_NEAR(mean_crossing(x) / sum, 1.0, 1e-5) << x;
  }
}

TEST(Elementary, SecondExponentialIntegralHoldsFromZeroOn) {
  EXPECT_EQ(second_exponential_integral(0.0), 1.0);
  for (double x = 1e-5; x < 20.0; x *= 1.3)
    EXPECT_NEAR(second_exponential_integral(x) / (std::exp(-x) + x * std::expint(-x)), 1.0, 0.02) << x;
}

// An even source around a point, seen in all directions that a plane's half-space lies in.
TEST(Elementary, ScatteredShareBelowAPlaneIsItsIntegral) {
  for (const double depth : {0.0, 0.05, 0.3, 1.0, 4.0}) {
    constexpr int steps = 20000;
    double sum = 0.5;  // from below
    for (int i = 0; i < steps; ++i) sum -= 0.5 * std::expm1(-depth / ((i + 0.5) / steps)) / steps;
    EXPECT_NEAR(scattered_share_below(depth), sum, 2e-3) << depth;
  }
}

TEST(Elementary, AttenuatedDistanceInvertsItsDistribution) {
  for (const double rate : {0.02, 0.5, 3.0, 40.0})
    for (double random = 0.0; random < 1.0; random += 0.01) {
      const double distance = attenuated_distance(random, rate, 1.5, 1.5 * mean_attenuation(rate * 1.5));
      EXPECT_NEAR(std::expm1(-rate * distance) / std::expm1(-rate * 1.5), random, 1e-9) << rate;
    }
}

}  // namespace
}  // namespace mesograin::physics

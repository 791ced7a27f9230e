// The phase function integrates to one, has the mean cosine it is named after, and measures angles between refracted
// rays.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/physics.h"
#include "physics/quadrature.h"

namespace mesograin::physics {
namespace {

double phase(double versine, double g) { return henyey_greenstein(versine, std::abs(g), 1.0 - std::abs(g)); }

TEST(HenyeyGreenstein, IntegratesToOneWithMeanCosineG) {
  for (const double g : {-0.999, -0.9, -0.3, -1e-9, 0.0, 1e-6, 0.5, 0.9, 0.99, 0.999}) {
    double integral = 0.0;
    double mean_cosine = 0.0;
    // versine from 0 to 2 by halves, so that the peak of width (1-|g|)^2 is resolved.
    double high = 2.0;
    for (int interval = 0; interval < 60; ++interval, high *= 0.5)
      for (const QuadratureNode& node : gauss_legendre(24)) {
        const double versine = 0.5 * high * (1.0 + node.x);
        const double cosine = g >= 0.0 ? 1.0 - versine : versine - 1.0;
        const double weight = 2.0 * PI * 0.5 * high * node.weight * phase(versine, g);
        integral += weight;
        mean_cosine += weight * cosine;
      }
    EXPECT_NEAR(integral, 1.0, 1e-10) << g;
    EXPECT_NEAR(mean_cosine, g, 1e-10) << g;
  }
}

TEST(HenyeyGreenstein, IsThePrintedForm) {
  for (const double g : {-0.7, 0.2, 0.8})
    for (double cosine = -1.0; cosine <= 1.0; cosine += 0.1) {
      const double printed = (1.0 - g * g) / (4.0 * PI * std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5));
      EXPECT_NEAR(phase(g >= 0.0 ? 1.0 - cosine : 1.0 + cosine, g), printed, 1e-12);
    }
}

TEST(HenyeyGreenstein, SeesTheAngleBetweenRefractedRays) {
  const real3 normal(0.0, 0.0, 1.0);
  const real3 to_light(0.6, 0.0, 0.8);
  const real3 to_viewer = glm::normalize(real3(-0.3, 0.5, 0.7));
  const double eta = 1.4;
  const double mu_i = refracted_cosine(to_light.z, eta);
  const double mu_o = refracted_cosine(to_viewer.z, eta);
  const real3 inward(-to_light.x / eta, -to_light.y / eta, -mu_i);
  const real3 outward(to_viewer.x / eta, to_viewer.y / eta, mu_o);
  ASSERT_NEAR(dot(inward, inward), 1.0, 1e-12);
  const double cosine = dot(inward, outward);
  const auto versine = [&](double sign) {
    return refracted_versine(to_light, to_light.z, mu_i, to_viewer, to_viewer.z, mu_o, normal, 1.0 / (eta * eta), sign);
  };
  EXPECT_NEAR(versine(1.0), 1.0 - cosine, 1e-12);
  EXPECT_NEAR(versine(-1.0), 1.0 + cosine, 1e-12);
}

}  // namespace
}  // namespace mesograin::physics

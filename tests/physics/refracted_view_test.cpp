// The view's side of Cycles 4's random walk: a refracted view ray, averaged over the visible normals.
#include "physics/half_space/refracted_view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "physics/physics.h"

namespace mesograin::physics {
namespace {

const Medium medium{0.9, 0.1, 0.0};

TEST(RefractedView, SmoothInterfaceIsOneRefraction) {
  const HalfSpaceInterior interior(medium);
  for (const double eta : {1.0, 1.3, 3.0}) {
    const RefractedView view(medium, eta, 0.0);
    for (const double mu : {0.02, 0.3, 1.0})
      EXPECT_NEAR(view.albedo(mu), interior.plane_albedo(refracted_cosine(mu, eta)), 2e-5) << eta << " " << mu;
  }
}

// The average over D_v = G_1 D max(0, h.v)/mu (Heitz 2014 eq. 16), by brute force over the sphere of normals.
double brute_force(double mu, double eta, double alpha) {
  const HalfSpaceInterior interior(medium);
  std::vector<double> albedo;
  for (int i = 0; i <= 2000; ++i) albedo.push_back(interior.plane_albedo(i / 2000.0));
  const real3 view(std::sqrt(1.0 - mu * mu), 0.0, mu);
  const double masking = 2.0 * mu / (mu + ggx_smith_root(mu, alpha));
  double sum = 0.0;
  constexpr int steps = 1000;
  for (int i = 0; i < steps; ++i) {
    const double theta = 0.5 * PI * (i + 0.5) / steps;
    for (int j = 0; j < 200; ++j) {
      const double phi = 2.0 * PI * (j + 0.5) / 200;
      const real3 normal(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      const double cosine = dot(normal, view);
      if (cosine <= 0.0) continue;
      const real3 inward = -view / eta + (cosine / eta - refracted_cosine(cosine, eta)) * normal;
      if (inward.z >= 0.0) continue;
      const double visible = masking * ggx_distribution(real3(0, 0, 1), normal, alpha) * cosine / mu;
      sum += visible * albedo[std::lround(-inward.z * 2000.0)] * std::sin(theta) * 0.5 * PI / steps * 2.0 * PI / 200;
    }
  }
  return sum;
}

TEST(RefractedView, RoughInterfaceAveragesOverVisibleNormals) {
  for (const double alpha : {0.2, 0.6, 1.0})
    for (const double mu : {0.1, 0.5, 0.95})
      EXPECT_NEAR(RefractedView(medium, 1.3, alpha).albedo(mu), brute_force(mu, 1.3, alpha), 2e-3)
          << alpha << " " << mu;
}

TEST(RefractedView, StaysBelowOneAtItsEnds) {
  for (const double eta : {0.5, 1.0, 4.0})
    for (const double alpha : {0.0, 1e-6, 1.0})
      for (const double mu : {0.0, 1e-9, 1.0}) {
        const double albedo = RefractedView(Medium{1.0, 0.0, 0.0}, eta, alpha).albedo(mu);
        EXPECT_GE(albedo, 0.0);
        EXPECT_LE(albedo, 1.0);
      }
}

}  // namespace
}  // namespace mesograin::physics

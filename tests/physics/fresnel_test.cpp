// Fresnel's equations against their textbook form, and their moments against brute force and a closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "physics/fresnel_moments.h"
#include "physics/physics.h"

namespace mesograin::physics {
namespace {

// Born & Wolf as printed: complex cosines carry total internal reflection by themselves.
double textbook_reflectance(double mu, double eta) {
  const std::complex<double> mu_t = std::sqrt(std::complex<double>(1.0 - (1.0 - mu * mu) / (eta * eta)));
  const auto s = (mu - eta * mu_t) / (mu + eta * mu_t);
  const auto p = (eta * mu - mu_t) / (eta * mu + mu_t);
  return 0.5 * (std::norm(s) + std::norm(p));
}

TEST(Fresnel, AgreesWithTheTextbook) {
  for (double eta = 0.5; eta <= 4.0; eta += 0.0625) {
    for (double mu = 1e-6; mu <= 1.0; mu += 0.01) {
      const double expected = textbook_reflectance(mu, eta);
      EXPECT_NEAR(fresnel_reflectance(mu, eta), expected, 1e-10) << mu << " " << eta;
      EXPECT_NEAR(fresnel_transmittance(mu, refracted_cosine(mu, eta), eta), 1.0 - expected, 1e-10) << mu << " " << eta;
    }
  }
}

TEST(Fresnel, HoldsAtItsEnds) {
  EXPECT_EQ(fresnel_transmittance(0.0, refracted_cosine(0.0, 1.5), 1.5), 0.0);
  EXPECT_EQ(fresnel_reflectance(0.0, 1.5), 1.0);
  EXPECT_NEAR(fresnel_reflectance(1.0, 1.5), 0.04, 1e-15);
  EXPECT_EQ(fresnel_reflectance(0.5, 0.5), 1.0);  // beyond the critical angle
  EXPECT_EQ(fresnel_transmittance(0.5, refracted_cosine(0.5, 0.5), 0.5), 0.0);
  EXPECT_DOUBLE_EQ(fresnel_transmittance(0.3, refracted_cosine(0.3, 1.0), 1.0), 1.0);
}

TEST(Fresnel, PassesTheSameBothWays) {
  for (const double eta : {1.01, 1.3, 2.4, 4.0}) {
    for (double mu = 0.01; mu < 1.0; mu += 0.01) {
      const double inside = refracted_cosine(mu, eta);
      EXPECT_NEAR(refracted_cosine(inside, 1.0 / eta), mu, 1e-12);
      EXPECT_NEAR(fresnel_transmittance(mu, inside, eta), fresnel_transmittance(inside, mu, 1.0 / eta), 1e-14);
    }
  }
}

// Midpoints, a million of them: slow to converge at the critical angle, but it knows nothing of where that is.
FresnelMoments brute_force_moments(double eta) {
  constexpr int count = 1000000;
  double first = 0.0;
  double second = 0.0;
  for (int i = 0; i < count; ++i) {
    const double mu = (i + 0.5) / count;
    const double transmittance = 1.0 - textbook_reflectance(mu, eta);
    first += 2.0 * mu * transmittance / count;
    second += 3.0 * mu * mu * transmittance / count;
  }
  return {first, second};
}

TEST(FresnelMoments, AgreeWithBruteForce) {
  for (const double eta : {0.5, 0.66, 1.0 / 1.3, 0.99, 1.0, 1.0001, 1.1, 1.5, 2.0, 2.85, 4.0}) {
    const FresnelMoments expected = brute_force_moments(eta);
    const FresnelMoments moments = fresnel_moments(eta);
    EXPECT_NEAR(moments.one_minus_two_c1, expected.one_minus_two_c1, 2e-8) << eta;
    EXPECT_NEAR(moments.one_minus_three_c2, expected.one_minus_three_c2, 2e-8) << eta;
  }
}

// 2 C_1 of light inside, integrated by hand (Duntley 1942; Walsh 1926).
double closed_two_c1_inside(double m) {
  const double m2 = m * m;
  const double outside = 0.5 + (m - 1) * (3 * m + 1) / (6 * (m + 1) * (m + 1)) +
                         m2 * (m2 - 1) * (m2 - 1) / std::pow(m2 + 1, 3) * std::log((m - 1) / (m + 1)) -
                         2 * m * m2 * (m2 + 2 * m - 1) / ((m2 + 1) * (m2 * m2 - 1)) +
                         8 * m2 * m2 * (m2 * m2 + 1) / ((m2 + 1) * (m2 * m2 - 1) * (m2 * m2 - 1)) * std::log(m);
  return 1.0 - (1.0 - outside) / m2;
}

TEST(FresnelMoments, AgreeWithTheClosedForm) {
  for (double eta = 1.02; eta <= 4.0; eta += 0.02)
    EXPECT_NEAR(fresnel_moments(1.0 / eta).two_c1(), closed_two_c1_inside(eta), 1e-11) << eta;
}

TEST(FresnelMoments, AreExactlyNothingWithoutAnInterface) {
  EXPECT_EQ(fresnel_moments(1.0).two_c1(), 0.0);
  EXPECT_EQ(fresnel_moments(1.0).three_c2(), 0.0);
  EXPECT_NEAR(fresnel_moments(1.0 + 1e-9).two_c1(), 0.0, 1e-8);
  EXPECT_NEAR(fresnel_moments(1.0 - 1e-9).three_c2(), 0.0, 1e-8);
}

// Values of a separate quadrature; no fitted polynomial in 1/eta reaches the last of them.
TEST(DiffusionBoundary, GivesTheAuditedConstants) {
  const std::pair<double, double> audited[] = {{1.0, 1.0},   {1.1, 1.350}, {1.3, 2.340}, {1.5, 3.628},
                                               {1.6, 4.379}, {2.0, 8.124}, {2.5, 14.62}, {2.7, 17.85}};
  for (const auto& [eta, a] : audited) EXPECT_NEAR(diffusion_boundary(eta).a, a, 6e-4 * a + 5e-4) << eta;
  EXPECT_NEAR(diffusion_boundary(1.3).exit_transmittance, 0.9389, 5e-5);
  EXPECT_NEAR(diffusion_boundary(1.5).exit_transmittance, 0.9082, 5e-5);
  EXPECT_NEAR(diffusion_boundary(1.6).exit_transmittance, 0.8938, 5e-5);
}

TEST(DiffusionBoundary, HoldsWhereThePublishedPolynomialsDoNot) {
  // d'Eon and Irving 2011, their fits of 2 C_1 and 3 C_2 for eta >= 1.
  const auto fitted = [](double eta) {
    const double first =
        -9.23372 + eta * (22.2272 + eta * (-20.9292 + eta * (10.2291 + eta * (-2.54396 + eta * 0.254913))));
    const double third = -1641.1 + 135.926 / (eta * eta * eta) - 656.175 / (eta * eta) + 1376.53 / eta +
                         eta * (1213.67 + eta * (-568.556 + eta * (164.798 + eta * (-27.0181 + eta * 1.91826))));
    return (1.0 + third) / (1.0 - first);
  };
  EXPECT_NEAR(fitted(1.5), diffusion_boundary(1.5).a, 0.01);
  EXPECT_LT(fitted(2.85), 0.0);  // a reflectance beyond 1
  double before = 0.0;
  for (double eta = 1.0; eta <= 4.0; eta += 0.01) {
    const double now = diffusion_boundary(eta).a;
    EXPECT_GT(now, before) << eta;
    before = now;
  }
}

TEST(DiffusionBoundary, KeepsTheIdentityOfItsTwoForms) {
  // A = (1 - C_E)/(2 C_phi) = (1 + 3 C_2)/(1 - 2 C_1).
  for (double eta = 0.5; eta <= 4.0; eta += 0.1) {
    const DiffusionBoundary boundary = diffusion_boundary(eta);
    EXPECT_NEAR((1.0 - boundary.c_e) / (2.0 * boundary.c_phi) / boundary.a, 1.0, 1e-12) << eta;
  }
}

}  // namespace
}  // namespace mesograin::physics

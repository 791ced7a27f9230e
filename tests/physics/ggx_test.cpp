// GGX: what a microfacet distribution must integrate to, and the energy of one bounce.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/physics.h"
#include "physics/quadrature.h"

namespace mesograin::physics {
namespace {

constexpr int panels = 24;

// Integrates over half vectors; tan(theta) runs over magnitudes around alpha, so that any alpha is resolved.
template <typename Integrand>
double integrate_half_vectors(double alpha, int azimuths, Integrand integrand) {
  double sum = 0.0;
  for (int panel = 0; panel < panels; ++panel) {
    for (const QuadratureNode& node : gauss_legendre(16)) {
      // tan^2 = alpha^2 t/(1-t): D cos becomes uniform in t.
      const double t = (panel + node.x) / panels;
      const double tan2 = alpha * alpha * t / (1.0 - t);
      const double cosine = 1.0 / std::sqrt(1.0 + tan2);
      const double sine = std::sqrt(tan2) * cosine;
      const double density =
          0.5 * alpha * alpha / ((1.0 - t) * (1.0 - t)) * cosine * cosine * cosine;  // sin dtheta / dt
      for (int step = 0; step < azimuths; ++step) {
        const double phi = 2.0 * PI * (step + 0.5) / azimuths;
        const real3 half_vector(sine * std::cos(phi), sine * std::sin(phi), cosine);
        sum += node.weight / panels * density * 2.0 * PI / azimuths * integrand(half_vector);
      }
    }
  }
  return sum;
}

const real3 normal(0.0, 0.0, 1.0);

TEST(Ggx, ProjectedAreaOfTheMicrofacetsIsOne) {
  for (const double alpha : {1e-4, 1e-3, 0.03, 0.3, 0.7, 1.0})
    EXPECT_NEAR(
        integrate_half_vectors(alpha, 4, [&](const real3& h) { return ggx_distribution(normal, h, alpha) * h.z; }), 1.0,
        1e-10)
        << alpha;
}

double furnace(double mu, double alpha, double (*visibility)(double, double, double)) {
  const real3 to_viewer(std::sqrt(1.0 - mu * mu), 0.0, mu);
  return integrate_half_vectors(alpha, 512, [&](const real3& h) {
    const double cosine = dot(h, to_viewer);
    const real3 to_light = 2.0 * cosine * h - to_viewer;
    if (cosine <= 0.0 || to_light.z <= 0.0) return 0.0;
    return ggx_distribution(normal, h, alpha) * visibility(to_light.z, mu, alpha) * to_light.z * 4.0 * cosine;
  });
}

TEST(Ggx, WhiteFurnaceGivesTheAuditedSingleBounceEnergy) {
  const double cosines[] = {1.0, 0.7, 0.4, 0.2, 0.05};
  const struct {
    double alpha;
    double energy[5];
  } audited[] = {{0.03, {0.999, 0.999, 0.996, 0.986, 0.902}},
                 {0.1, {0.988, 0.982, 0.957, 0.905, 0.912}},
                 {0.3, {0.878, 0.845, 0.816, 0.839, 0.931}},
                 {0.5, {0.687, 0.684, 0.717, 0.790, 0.912}},
                 {1.0, {0.307, 0.380, 0.498, 0.642, 0.847}}};
  for (const auto& row : audited)
    for (int i = 0; i < 5; ++i)
      EXPECT_NEAR(furnace(cosines[i], row.alpha, ggx_visibility_correlated), row.energy[i], 2e-3)
          << row.alpha << " " << cosines[i];
  EXPECT_NEAR(furnace(1.0, 1.0, ggx_visibility_correlated), 1.0 - std::log(2.0), 1e-4);
}

TEST(Ggx, NeverReturnsMoreThanItGot) {
  for (double alpha = GGX_SMALLEST_ALPHA; alpha <= 1.0; alpha *= 1.9)
    for (const double mu : {1.0, 0.6, 0.2, 0.05}) {
      const double correlated = furnace(mu, alpha, ggx_visibility_correlated);
      const double separable = furnace(mu, alpha, ggx_visibility_separable);
      EXPECT_LE(correlated, 1.0 + 1e-3) << alpha << " " << mu;
      EXPECT_LE(separable, correlated + 1e-9) << alpha << " " << mu;
      EXPECT_GT(separable, 0.0);
    }
}

TEST(Ggx, VisibilityIsThatOfSmith) {
  // Lambda in the form that subtracts, which double can bear here (Heitz 2014 eq. 72).
  const auto lambda = [](double mu, double alpha) {
    return 0.5 * (std::sqrt(1.0 + alpha * alpha * (1.0 - mu * mu) / (mu * mu)) - 1.0);
  };
  for (const double alpha : {0.05, 0.3, 1.0})
    for (double mu_i = 0.05; mu_i <= 1.0; mu_i += 0.05)
      for (double mu_o = 0.05; mu_o <= 1.0; mu_o += 0.05) {
        const double li = lambda(mu_i, alpha);
        const double lo = lambda(mu_o, alpha);
        const double projection = 4.0 * mu_i * mu_o;
        EXPECT_NEAR(ggx_visibility_correlated(mu_i, mu_o, alpha) * projection, 1.0 / (1.0 + li + lo), 1e-12);
        EXPECT_NEAR(ggx_visibility_separable(mu_i, mu_o, alpha) * projection, 1.0 / ((1.0 + li) * (1.0 + lo)), 1e-12);
      }
}

TEST(Ggx, IsFiniteAtGrazing) {
  for (const double alpha : {1e-3, 0.1, 1.0}) {
    EXPECT_TRUE(std::isfinite(ggx_visibility_correlated(0.0, 0.5, alpha)));
    EXPECT_TRUE(std::isfinite(ggx_visibility_correlated(0.0, 0.0, alpha)));
    EXPECT_TRUE(std::isfinite(ggx_visibility_separable(0.0, 0.0, alpha)));
  }
}

}  // namespace
}  // namespace mesograin::physics

// What facets send of light from everywhere, against an integral over the hemisphere that knows no visible normals.
#include "physics/half_space/facet_energy.h"

#include <gtest/gtest.h>

#include <cmath>

#include "physics/physics.h"

namespace mesograin::physics {
namespace {

constexpr int steps = 250;
constexpr double eta = 1.5;

// Midpoints, over the light's directions; `fresnel` tells what a facet reflects at a cosine.
template <typename Fresnel>
double sent(double mu, double alpha, Fresnel fresnel) {
  const real3 normal(0.0, 0.0, 1.0);
  const real3 to_viewer(std::sqrt(1.0 - mu * mu), 0.0, mu);
  double sum = 0.0;
  for (int row = 0; row < steps; ++row) {
    const double mu_i = (row + 0.5) / steps;
    for (int column = 0; column < steps; ++column) {
      const double phi = PI * (column + 0.5) / steps;  // the other half is its mirror image
      const double sine = std::sqrt(1.0 - mu_i * mu_i);
      const real3 half = glm::normalize(real3(sine * std::cos(phi), sine * std::sin(phi), mu_i) + to_viewer);
      sum += ggx_distribution(normal, half, alpha) * ggx_visibility_correlated(mu_i, mu, alpha) * mu_i *
             fresnel(glm::dot(half, to_viewer));
    }
  }
  return sum * 2.0 * PI / (steps * steps);
}

TEST(FacetEnergy, IsTheIntegralOverTheHemisphere) {
  const std::vector<double> roughnesses{0.5, 0.8, 1.0};
  const Table table = facet_energy(eta, roughnesses, scene::Masking::correlated);
  ASSERT_EQ(table.height, 3);
  for (int row = 0; row < table.height; ++row) {
    const double alpha = roughnesses[row] * roughnesses[row];
    double mean = 0.0;
    constexpr int mean_steps = 24;
    for (int i = 0; i < mean_steps; ++i) {
      const double mu = (i + 0.5) / mean_steps;
      mean += 2.0 * mu / mean_steps * sent(mu, alpha, [](double) { return 1.0; });
    }
    for (const int column : {6, 12, 20, 31}) {
      const double mu = std::pow(static_cast<double>(column) / (table.width - 1), 2.0);
      const glm::vec4 texel = table.texels[row * table.width + column];
      EXPECT_NEAR(texel.r, sent(mu, alpha, [](double) { return 1.0; }), 3e-3) << alpha << " " << mu;
      EXPECT_NEAR(texel.g, sent(mu, alpha, [](double c) { return fresnel_reflectance(c, eta); }), 1e-3)
          << alpha << " " << mu;
      EXPECT_NEAR(texel.b, mean, 2e-3) << alpha;
    }
  }
}

}  // namespace
}  // namespace mesograin::physics

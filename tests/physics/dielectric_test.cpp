// A rough dielectric surface against independent quadrature: what it reflects, what it lets in, and that nothing is
// made.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/half_space/dielectric_surface.h"
#include "physics/half_space/half_space.h"
#include "physics/physics.h"
#include "physics/quadrature.h"

namespace mesograin::physics {
namespace {

using scene::Masking;
using scene::Material;

const real3 normal(0.0, 0.0, 1.0);

// The integral over half vectors, tan^2 = alpha^2 t/(1-t) with t even, of the reflection towards every direction.
double reflected_by_half_vectors(double mu, double eta, double alpha, bool correlated) {
  constexpr int panels = 24;
  constexpr int azimuths = 96;  // over half a turn
  const real3 to_viewer(std::sqrt(1.0 - mu * mu), 0.0, mu);
  double sum = 0.0;
  for (int panel = 0; panel < panels; ++panel)
    for (const QuadratureNode& node : gauss_legendre(16)) {
      const double t = (panel + node.x) / panels;
      const double tan2 = alpha * alpha * t / (1.0 - t);
      const double cosine = 1.0 / std::sqrt(1.0 + tan2);
      const double sine = std::sqrt(tan2) * cosine;
      const double density = 0.5 * alpha * alpha / ((1.0 - t) * (1.0 - t)) * cosine * cosine * cosine;
      for (int step = 0; step < azimuths; ++step) {
        const double azimuth = PI * (step + 0.5) / azimuths;
        const real3 half(sine * std::cos(azimuth), sine * std::sin(azimuth), cosine);
        const double on_facet = dot(half, to_viewer);
        const real3 to_light = 2.0 * on_facet * half - to_viewer;
        if (on_facet <= 0.0 || to_light.z <= 0.0) continue;
        // d(to_light) = 4 cos d(half)
        sum += node.weight / panels * density * 2.0 * PI / azimuths * 4.0 * on_facet * to_light.z *
               dielectric_reflection(normal, to_light, to_light.z, to_viewer, mu, eta, alpha, correlated);
      }
    }
  return sum;
}

TEST(DielectricSurface, ReflectsWhatTheIntegralOverHalfVectorsSays) {
  for (const double eta : {0.7, 1.05, 1.3, 2.0, 4.0})
    for (const double alpha : {0.02, 0.2, 0.6, 1.0})
      for (const double mu : {0.03, 0.2, 0.6, 1.0})
        for (const Masking masking : {Masking::correlated, Masking::separable})
          EXPECT_NEAR(RoughDielectric(eta, alpha, masking).reflected(mu),
                      reflected_by_half_vectors(mu, eta, alpha, masking == Masking::correlated),
                      eta < 1.0 ? 4e-3 : 1e-3)  // total reflection begins at an edge
              << eta << " " << alpha << " " << mu;
}

TEST(DielectricSurface, IsFresnelsWhereItIsSmooth) {
  for (const double eta : {0.65, 1.2, 1.6, 3.0})
    for (const double mu : {0.1, 0.4, 0.8, 1.0})
      EXPECT_NEAR(RoughDielectric(eta, 0.0, Masking::correlated).reflected(mu), fresnel_reflectance(mu, eta), 2e-4)
          << eta << " " << mu;
}

TEST(DielectricSurface, TakesInWhatItDoesNotReflect) {
  for (const double alpha : {0.1, 0.5, 1.0}) {
    const RoughDielectric denser(1.5, alpha, Masking::correlated);
    const RoughDielectric rarer(0.7, alpha, Masking::correlated);
    for (const double mu : {0.05, 0.3, 0.9}) {
      EXPECT_DOUBLE_EQ(denser.reflected(mu) + denser.entering(mu), 1.0);
      EXPECT_LE(rarer.reflected(mu) + rarer.entering(mu), 1.0);
    }
    EXPECT_EQ(rarer.entering(0.5), 0.0);  // beyond the critical angle
  }
}

// Of the facets that are seen at the cosine mu, evenly drawn; `visit(facet, to_viewer)`.
template <class Visit>
double mean_over_facets(double mu, double alpha, const Visit& visit) {
  constexpr int across = 64;
  const real3 to_viewer(std::sqrt(1.0 - mu * mu), 0.0, mu);
  double sum = 0.0;
  for (int i = 0; i < across * across; ++i) {
    const int row = i / across;
    sum += visit(
        ggx_visible_facet(real3(0.0, 0.0, 1.0), to_viewer, alpha, {(i % across + 0.5) / across, (row + 0.5) / across}),
        to_viewer);
  }
  return sum / (across * across);
}

double passed_by_facets(double mu, double eta, double alpha) {
  return mean_over_facets(mu, alpha, [&](const real3& facet, const real3& to_viewer) {
    const double on_facet = dot(facet, to_viewer);
    return dielectric_facet_passed(on_facet, 2.0 * on_facet * facet.z - mu, mu, eta, alpha, true);
  });
}

TEST(DielectricSurface, LetsThroughSingleFacetsWhatItDoesNotReflect) {
  for (const double eta : {1.05, 1.3, 2.0})
    for (const double alpha : {0.1, 0.4, 1.0})
      for (const double mu : {0.05, 0.4, 1.0})
        EXPECT_NEAR(passed_by_facets(mu, eta, alpha), RoughDielectric(eta, alpha, Masking::correlated).entering(mu),
                    2e-3)
            << eta << " " << alpha << " " << mu;
}

// Light that is even everywhere has eta^2 the radiance inside (Nicodemus 1963).
TEST(DielectricSurface, LetsOutThroughSingleFacetsAsMuchAsIn) {
  for (const double eta : {1.05, 1.1, 1.3, 1.8})
    for (const double alpha : {0.06, 0.125, 0.25, 0.5}) {
      double enters = 0.0, leaves = 0.0;
      for (const QuadratureNode& node : gauss_legendre(32)) {
        const double mu = std::sqrt(node.x);  // by its cosine
        enters += node.weight * passed_by_facets(mu, eta, alpha);
        leaves += node.weight * mean_over_facets(mu, alpha, [&](const real3& facet, const real3& along) {
                    const double on_facet = dot(facet, along), beyond = 1.0 - eta * eta * (1.0 - on_facet * on_facet);
                    const double mu_beyond =
                        eta * (mu - on_facet * facet.z) + std::sqrt(std::max(beyond, 0.0)) * facet.z;
                    return eta * eta * (1.0 - dielectric_facet_kept(on_facet, mu_beyond, eta, alpha));
                  });
      }
      EXPECT_NEAR(leaves / enters, 1.0, 0.016) << eta << " " << alpha;
    }
}

// Reflected plus what leaves again of a half-space that does not absorb, at each angle of the light.
double sent_back(const Material& material, double mu) {
  const Passage passage = rough_passage(material);
  const auto through = [&](double cosine) {
    const double position = std::sqrt(cosine) * static_cast<double>(passage.transmittance.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(position), passage.transmittance.size() - 2);
    return std::lerp(passage.transmittance[i], passage.transmittance[i + 1], position - static_cast<double>(i));
  };
  std::vector<double> outside{mu};
  std::vector<double> weights{0.0};
  for (int panel = 0; panel < 8; ++panel)
    for (const QuadratureNode& node : gauss_legendre(16)) {
      const double root = (panel + node.x) / 8.0;
      outside.push_back(root * root);
      weights.push_back(2.0 * PI * root * root * 2.0 * root * node.weight / 8.0);
    }
  std::vector<double> inside;
  inside.reserve(outside.size());
  for (const double cosine : outside) inside.push_back(refracted_cosine(cosine, material.eta));
  const std::vector<double> table = HalfSpace({1.0, 0.0, material.g}, material.eta).interior_table(inside, true);
  double sum = RoughDielectric(material.eta, material.roughness, material.masking).reflected(mu);
  for (std::size_t j = 1; j < outside.size(); ++j)
    sum += weights[j] * through(mu) * through(outside[j]) *
           half_space_factor(inside[0], inside[j], 1.0, 1.0 / (material.eta * material.eta)) * table[j];
  return sum;
}

TEST(DielectricSurface, SendsBackAllOfTheLightIfNothingAbsorbs) {
  Material material;
  material.sigma_a = glm::dvec3(0.0);
  for (const double eta : {1.02, 1.3, 1.6, 2.5, 4.0})
    for (const double alpha : {0.01, 0.1, 0.4, 1.0})
      for (const double mu : {0.02, 0.1, 0.4, 1.0}) {
        material.eta = eta;
        material.roughness = alpha;
        EXPECT_NEAR(sent_back(material, mu), 1.0, 3e-3) << eta << " " << alpha << " " << mu;
      }
}

}  // namespace
}  // namespace mesograin::physics

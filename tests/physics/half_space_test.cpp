// The half-space solver against tables, Monte Carlo and the laws it must keep.
#include "physics/half_space/half_space.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/error.h"
#include "physics/half_space/half_space_albedo.h"
#include "physics/physics.h"
#include "physics/quadrature.h"

namespace mesograin::physics {
namespace {

Medium medium(double albedo, double g = 0.0) { return {albedo, 1.0 - albedo, g}; }

// Chandrasekhar's H in closed form (Stibbs & Weir 1959 eq. 14), with tan(theta) = tan(phi)/mu so that small mu is no
// harder.
double closed_h(double albedo, double mu) {
  double integral = 0.0;
  // phi from 0 to pi/2 by halves towards 0, where a conservative medium has a logarithm.
  double high = 0.5 * PI;
  for (int interval = 0; interval < 50; ++interval, high *= 0.5)
    for (const QuadratureNode& node : gauss_legendre(24)) {
      const double phi = 0.5 * high * (1.0 + node.x);
      const double theta = std::atan(std::tan(phi) / mu);
      const double theta_cot = theta < 1e-4 ? 1.0 - theta * theta / 3.0 : theta / std::tan(theta);
      const double one_minus = theta < 1e-4 ? theta * theta / 3.0 : 1.0 - theta_cot;
      integral += 0.5 * high * node.weight * std::log((1.0 - albedo) + albedo * one_minus);
    }
  return std::exp(-integral / PI);
}

TEST(HFunction, AgreesWithTheClosedForm) {
  const std::vector<double> mu{1e-3, 0.01, 0.05, 0.2, 0.5, 0.8, 1.0};
  for (const double albedo : {0.01, 0.3, 0.8, 0.99, 0.99999, 1.0}) {
    const Eigen::MatrixXd h = HalfSpaceInterior(medium(albedo)).functions(mu);
    for (std::size_t i = 0; i < mu.size(); ++i)
      EXPECT_NEAR(h(0, i) / closed_h(albedo, mu[i]), 1.0, 2e-6) << albedo << " " << mu[i];
  }
}

TEST(HFunction, AgreesWithChandrasekharsTable) {
  // Chandrasekhar 1960, table XI: H(1) for albedo 0.5, 0.9 and 1; the moment alpha_0 = 2/albedo (1 - sqrt(1 - albedo)).
  EXPECT_NEAR(HalfSpaceInterior(medium(0.5)).functions({1.0})(0, 0), 1.2513, 1e-3);
  EXPECT_NEAR(HalfSpaceInterior(medium(1.0)).functions({1.0})(0, 0), 2.9078, 1e-4);
  for (const double albedo : {0.2, 0.7, 1.0}) {
    const HalfSpaceInterior interior(medium(albedo));
    double moment = 0.0;
    for (const QuadratureNode& node : gauss_legendre(48))
      moment += 2.0 * node.x * node.weight * interior.functions({node.x * node.x})(0, 0);
    EXPECT_NEAR(moment, 2.0 / albedo * (1.0 - std::sqrt(1.0 - albedo)), 2e-6);
  }
}

struct Anchor {
  double eta;
  double albedo;
  double first_order;
  double multiple;
};

// Photon Monte Carlo, double precision, normal incidence, per transmitted flux; noise about 0.5 %.
constexpr Anchor anchors[] = {{1.0, .1, .0154, .0010},   {1.0, .5, .0766, .0385},   {1.0, .8, .1226, .1626},
                              {1.0, .9, .1377, .2770},   {1.0, .95, .1457, .3899},  {1.0, .99, .1521, .6005},
                              {1.0, .999, .1535, .7592}, {1.3, .1, .0076, .0007},   {1.3, .5, .0379, .0257},
                              {1.3, .8, .0605, .1210},   {1.3, .9, .0681, .2226},   {1.3, .95, .0718, .3357},
                              {1.3, .99, .0752, .5816},  {1.3, .999, .0758, .7963}, {1.5, .1, .0053, .0005},
                              {1.5, .5, .0268, .0193},   {1.5, .8, .0431, .0945},   {1.5, .9, .0483, .1805},
                              {1.5, .95, .0509, .2833},  {1.5, .99, .0527, .5327},  {1.5, .999, .0540, .7810}};

TEST(HalfSpace, ReachesEveryMonteCarloAnchorWithinOnePercent) {
  for (const Anchor& anchor : anchors) {
    const double total = anchor.first_order + anchor.multiple;
    // The anchors have four decimals.
    EXPECT_NEAR(HalfSpace(medium(anchor.albedo), anchor.eta).albedo_inside(1.0), total, 0.01 * total + 5e-5)
        << "eta " << anchor.eta << " albedo " << anchor.albedo;
  }
}

TEST(HalfSpace, ReachesTheSphericalAlbedoAnchors) {
  const std::pair<double, double> spherical[] = {{.5, .1459}, {.8, .3421}, {.9, .4788}, {.99, .7953}, {.999, .9296}};
  for (const auto& [albedo, value] : spherical)
    EXPECT_NEAR(HalfSpaceInterior(medium(albedo)).spherical_albedo(), value, 0.005 * value) << albedo;
}

// The half-space by brute force: photons along `mu` inside, counted when they leave.
double monte_carlo_albedo(const Medium& medium, double eta, double mu, int photons, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform;
  double escaped = 0.0;
  for (int photon = 0; photon < photons; ++photon) {
    double depth = 0.0;
    double direction = mu;  // cosine downwards
    double weight = 1.0;
    while (weight > 0.0) {
      depth -= direction * std::log(1.0 - uniform(random));
      // Up and out, or reflected by the interface as often as it is met.
      if (depth < 0.0) {
        if (eta == 1.0 || uniform(random) > fresnel_reflectance(-direction, 1.0 / eta)) {
          escaped += weight;
          break;
        }
        // The reflected path is the mirror image of the one that left.
        depth = -depth;
        direction = -direction;
      }
      weight *= medium.albedo;
      if (weight < 1e-3) weight = uniform(random) < 0.1 ? weight * 10.0 : 0.0;
      const double xi = uniform(random);
      const double g = medium.g;
      const double ratio = (1.0 - g * g) / (1.0 - g + 2.0 * g * xi);
      const double cosine = g == 0.0 ? 1.0 - 2.0 * xi : (1.0 + g * g - ratio * ratio) / (2.0 * g);
      direction = std::clamp(direction * cosine + std::sqrt((1.0 - direction * direction) * (1.0 - cosine * cosine)) *
                                                      std::cos(2.0 * PI * uniform(random)),
                             -1.0, 1.0);
    }
  }
  return escaped / photons;
}

TEST(HalfSpace, AgreesWithMonteCarloForAnyAnisotropy) {
  unsigned seed = 1;
  for (const double g : {-0.9, -0.4, 0.3, 0.75, 0.9})
    for (const double albedo : {0.5, 0.95})
      for (const double eta : {0.7, 1.0, 1.5})
        for (const double mu : {0.8, 1.0}) {
          constexpr int photons = 20000;
          const double expected = monte_carlo_albedo(medium(albedo, g), eta, mu, photons, seed++);
          const double sigma = std::sqrt(expected / photons);
          EXPECT_NEAR(HalfSpace(medium(albedo, g), eta).albedo_inside(mu), expected, 4.0 * sigma + 1e-3 * expected)
              << "g " << g << " albedo " << albedo << " eta " << eta << " mu " << mu;
        }
}

TEST(HalfSpace, IsContinuousAtIsotropyAndAtEqualIndices) {
  for (const double albedo : {0.3, 0.9, 0.999}) {
    for (const double mu : {0.05, 0.5, 1.0}) {
      const double isotropic = HalfSpaceInterior(medium(albedo)).plane_albedo(mu);
      EXPECT_NEAR(HalfSpaceInterior(medium(albedo, 1e-7)).plane_albedo(mu), isotropic, 2e-5);
      EXPECT_NEAR(HalfSpaceInterior(medium(albedo, -1e-7)).plane_albedo(mu), isotropic, 2e-5);
      const double matched = HalfSpace(medium(albedo), 1.0).albedo(mu);
      EXPECT_NEAR(HalfSpace(medium(albedo), 1.0 + 1e-6).albedo(mu), matched, 2e-4);
      EXPECT_NEAR(HalfSpace(medium(albedo), 1.0 - 1e-6).albedo(mu), matched, 2e-4);
    }
  }
}

TEST(HalfSpace, ReturnsEverythingWithoutAbsorptionAndNothingWithoutScattering) {
  for (const double eta : {0.5, 0.9, 1.0, 1.1, 1.5, 4.0})
    for (const double g : {-0.9, 0.0, 0.5, 0.9}) {
      const HalfSpace conservative(Medium{1.0, 0.0, g}, eta);
      for (const double mu : {0.1, 0.5, 1.0}) {
        EXPECT_NEAR(conservative.albedo_inside(mu), 1.0, std::abs(g) > 0.8 ? 1e-3 : 1e-4)
            << eta << " " << g << " " << mu;
        EXPECT_LE(conservative.albedo_inside(mu), 1.0 + 1e-5) << eta << " " << g << " " << mu;
      }
      EXPECT_EQ(HalfSpace(Medium{0.0, 1.0, g}, eta).albedo(0.7), 0.0);
    }
}

TEST(HalfSpace, TableHoldsWhatTheAlbedoSaysAndIsReciprocal) {
  // Integrates the table over the directions that leave and compares with the solver's own sum over its nodes.
  for (const double eta : {1.0, 1.3, 2.0})
    for (const double g : {0.0, 0.6}) {
      std::vector<double> outside;
      std::vector<double> inside{0.9};
      std::vector<double> weights;
      for (const QuadratureNode& node : gauss_legendre(40)) {
        const double mu = node.x * node.x;
        inside.push_back(refracted_cosine(mu, eta));
        weights.push_back(2.0 * PI * 2.0 * node.x * node.weight * mu / (eta * eta) *
                          fresnel_transmittance(mu, inside.back(), eta));
      }
      const HalfSpace half_space(medium(0.9, g), eta);
      const std::vector<double> table = half_space.interior_table(inside, true);
      const std::size_t size = inside.size();
      double albedo = 0.0;
      for (std::size_t i = 1; i < size; ++i) albedo += weights[i - 1] * table[i] / (inside[0] + inside[i]);
      EXPECT_NEAR(albedo, half_space.albedo_inside(0.9), 2e-5) << eta << " " << g;
      for (std::size_t i = 0; i < size; ++i)
        for (std::size_t j = 0; j < i; ++j) EXPECT_NEAR(table[i * size + j], table[j * size + i], 1e-10);
    }
}

TEST(HalfSpace, CountsNoOrderTwice) {
  // What the table holds beyond the higher orders is isotropic single scattering, and it has the energy of the anchors.
  for (const Anchor& anchor : anchors) {
    const HalfSpace half_space(medium(anchor.albedo), anchor.eta);
    std::vector<double> inside{1.0};
    std::vector<double> weights;
    for (const QuadratureNode& node : gauss_legendre(40)) {
      const double mu = node.x * node.x;
      inside.push_back(refracted_cosine(mu, anchor.eta));
      weights.push_back(4.0 * PI * node.x * node.weight * mu / (anchor.eta * anchor.eta) *
                        fresnel_transmittance(mu, inside.back(), anchor.eta));
    }
    const std::vector<double> all = half_space.interior_table(inside, true);
    const std::vector<double> higher = half_space.interior_table(inside, false);
    double first_order = 0.0;
    for (std::size_t i = 0; i < all.size(); ++i) EXPECT_NEAR(all[i] - higher[i], anchor.albedo / (4.0 * PI), 1e-12);
    for (std::size_t i = 1; i < inside.size(); ++i)
      first_order += weights[i - 1] * (all[i] - higher[i]) / (inside[0] + inside[i]);
    EXPECT_NEAR(first_order, anchor.first_order, 0.012 * anchor.first_order + 5e-5)
        << anchor.eta << " " << anchor.albedo;
  }
}

TEST(HalfSpaceAlbedo, AnswersForEveryBoundary) {
  scene::Material material;
  material.model = scene::Model::model_1;
  material.sigma_a = {0.5, 0.2, 0.1};
  material.sigma_s = {0.5, 0.8, 0.9};
  material.eta = 1.5;
  // Photon Monte Carlo at normal incidence, times the 4 % that the interface keeps out.
  EXPECT_NEAR(half_space_albedo(material, 1.0).b, 0.96 * 0.2288, 0.003);
  material.boundary = scene::Boundary::index_matched;
  EXPECT_NEAR(half_space_albedo(material, 1.0).b, 0.4147, 0.002);
  // Light from everywhere is the cosine lobe.
  const glm::dvec3 even = half_space_albedo(material, std::nullopt);
  material.boundary = scene::Boundary::lambert_lambert;
  const glm::dvec3 lobe = half_space_albedo(material, 0.3);
  for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(even[channel], lobe[channel], 1e-5);
  // A view that is refracted looks in more steeply, where less comes back.
  material.boundary = scene::Boundary::lambert_refracted;
  EXPECT_LT(half_space_albedo(material, 0.3).r, lobe.r);
  EXPECT_GT(half_space_albedo(material, 0.3).r, 0.0);
  EXPECT_THROW(half_space_albedo(material, 0.0), Error);
  EXPECT_THROW(half_space_albedo(material, std::nan("")), Error);
}

}  // namespace
}  // namespace mesograin::physics

// The sphere against energy, closed forms, another Monte Carlo's figures, and its own table.
#include "sphere.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "interface.h"
#include "stored_table.h"

namespace mesograin::referee {
namespace {

constexpr int sigmas = 5;

/// Flux reflected at entry per flux incident: 2 int F(mu) mu dmu, by the midpoint rule.
double specular_share(double eta) {
  constexpr int steps = 100'000;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double mu = (i + 0.5) / steps;
    sum += 2 * mu * fresnel(mu, eta) / steps;
  }
  return sum;
}

struct Conservative {
  double radius, eta, g;
};

TEST(Sphere, WithoutAbsorptionAllLightComesBack) {
  for (const Conservative& given :
       {Conservative{5, 1.3, 0}, Conservative{6, 1.6, 0.8}, Conservative{2, 1, 0}, Conservative{3, 0.8, 0}}) {
    const SphereResult result = trace_sphere(
        {.radius = given.radius, .eta = given.eta, .g = given.g, .albedos = {1}, .bins = 4}, {300'000, 51, 0});
    const double noise = std::hypot(result.scattered_total[0].noise, result.ballistic_total.noise);
    EXPECT_NEAR(result.specular.value + result.ballistic_total.value + result.scattered_total[0].value, 1,
                sigmas * noise)
        << "eta " << given.eta;
    EXPECT_LT(noise, 0.003);
    EXPECT_NEAR(result.specular.value, specular_share(given.eta), 1e-4) << "eta " << given.eta;
  }
}

TEST(Sphere, UnscatteredLightWithoutInterfaceFollowsItsChords) {
  // Exponential of the chords of a uniformly lit disc: 2 int_0^1 exp(-2 R c) c dc.
  const double x = 2 * 1.5;
  const double exact = 2 * (1 - std::exp(-x) * (1 + x)) / (x * x);
  for (Entry entry : {Entry::refracted, Entry::lambert}) {  // chords of a cosine lobe are distributed alike
    const SphereResult result = trace_sphere({.radius = 1.5, .entry = entry, .albedos = {0.5}}, {400'000, 52, 0});
    EXPECT_NEAR(result.ballistic_total.value, exact, sigmas * result.ballistic_total.noise);
  }
}

TEST(Sphere, LambertEntryAgreesWithAnotherMonteCarlo) {
  // Albedo .9, radius 2.4: exitance of all orders at cosines -.9, .1 and .9, printed with three decimals.
  const SphereResult result =
      trace_sphere({.radius = 2.4, .entry = Entry::lambert, .albedos = {0.9}, .bins = 20}, {1'000'000, 53, 0});
  const auto at = [&](int bin) { return result.scattered[0][bin].value + result.ballistic[bin].value; };
  EXPECT_NEAR(0.5 * (at(0) + at(1)), 0.034, 0.001);
  EXPECT_NEAR(0.5 * (at(10) + at(11)), 0.150, 0.003);
  EXPECT_NEAR(0.5 * (at(18) + at(19)), 0.492, 0.005);
}

TEST(Sphere, AnOpaqueOneIsLocallyAHalfSpace) {
  // At radius 400 and albedo .5 the exitance facing the light is that of a half-space (table half_space.json).
  const StoredTable half_space("half_space.json");
  const std::vector<double> albedos = half_space.head("albedos");
  const auto index = std::find(albedos.begin(), albedos.end(), 0.5) - albedos.begin();
  const SphereResult result =
      trace_sphere({.radius = 400, .eta = 1.3, .albedos = {0.5}, .bins = 100}, {250'000, 54, 0});
  const Estimate facing = result.scattered[0].back();  // cosines .98 to 1
  for (const nlohmann::json& stored : half_space.cases()) {
    if (stored["eta"] != 1.3 || stored["g"] != 0.0 || stored["incidence"] != 1.0) continue;
    const double transmitted = 1 - fresnel(1, 1.3);
    EXPECT_NEAR(facing.value, 0.99 * transmitted * stored["total"][index].get<double>(), sigmas * facing.noise + 5e-4);
    return;
  }
  FAIL() << "no half-space at eta 1.3";
}

TEST(Sphere, DoesNotDependOnTheNumberOfThreads) {
  const SphereCase setup{.radius = 2, .eta = 1.5, .albedos = {0.9}};
  const SphereResult one = trace_sphere(setup, {20'000, 55, 1});
  const SphereResult three = trace_sphere(setup, {20'000, 55, 3});
  for (int bin = 0; bin < setup.bins; ++bin) EXPECT_EQ(one.scattered[0][bin].value, three.scattered[0][bin].value);
}

void expect_stored(const nlohmann::json& stored, const SphereCase& setup) {
  const SphereResult result = trace_sphere(setup, {60'000, 56, 0});
  for (std::size_t a = 0; a < setup.albedos.size(); ++a) {
    const double noise = std::hypot(result.scattered_total[a].noise, stored["scattered_total_noise"][a].get<double>());
    EXPECT_NEAR(result.scattered_total[a].value, stored["scattered_total"][a].get<double>(), sigmas * noise)
        << stored["entry"] << ", g " << setup.g << ", eta " << setup.eta << ", radius " << setup.radius << ", albedo "
        << setup.albedos[a];
    for (int bin = 20; bin < 40; ++bin) {
      const double bin_noise =
          std::hypot(result.scattered[a][bin].noise, stored["scattered_noise"][a][bin].get<double>());
      EXPECT_NEAR(result.scattered[a][bin].value, stored["scattered"][a][bin].get<double>(), (sigmas + 1) * bin_noise)
          << stored["entry"] << ", g " << setup.g << ", eta " << setup.eta << ", radius " << setup.radius << ", albedo "
          << setup.albedos[a] << ", bin " << bin;
    }
  }
}

SphereCase stored_case(const StoredTable& table, const nlohmann::json& stored) {
  return {.radius = stored["radius"],
          .eta = stored["eta"],
          .g = stored.value("g", 0.0),
          .entry = stored["entry"] == "lambert" ? Entry::lambert : Entry::refracted,
          .albedos = table.head("albedos"),
          .bins = 40};
}

TEST(Sphere, ItsTableHoldsForFreshSeeds) {
  const StoredTable table("sphere.json");
  ASSERT_EQ(table.cases().size(), 20u);
  for (const nlohmann::json& stored : table.cases()) expect_stored(stored, stored_case(table, stored));
}

// (In the thickest a photon is scattered a hundred times.)
TEST(Sphere, ItsAnisotropicTableHoldsForFreshSeeds) {
  const StoredTable table("sphere_anisotropic.json");
  ASSERT_EQ(table.cases().size(), 60u);
  for (const nlohmann::json& stored : table.cases())
    if (stored["radius"] < 20.0) expect_stored(stored, stored_case(table, stored));
}

}  // namespace
}  // namespace mesograin::referee

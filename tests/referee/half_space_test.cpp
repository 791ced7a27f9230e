// The half-space against Chandrasekhar's exact solution, against anchors of an independent Monte Carlo, and against its
// own table.
#include "half_space.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "chandrasekhar.h"
#include "stored_table.h"

namespace mesograin::referee {
namespace {

constexpr int sigmas =
    5;  ///< of noise that a comparison allows: with thousands of comparisons 4 would fail now and then

HalfSpaceCase normal_incidence(double eta, std::vector<double> albedos) {
  HalfSpaceCase setup;
  setup.eta = eta;
  setup.albedos = std::move(albedos);
  return setup;
}

TEST(HalfSpace, WithoutInterfaceIsChandrasekharsSolution) {
  const std::vector<double> albedos{0.1, 0.5, 0.8, 0.9, 0.99, 0.999, 0.9999};
  for (bool diffuse : {false, true}) {
    HalfSpaceCase setup = normal_incidence(1, albedos);
    setup.incidence.diffuse = diffuse;
    const HalfSpaceResult result = trace_half_space(setup, {400'000, 41, 0});
    for (std::size_t a = 0; a < albedos.size(); ++a) {
      const ChandrasekharH h(albedos[a]);
      const double exact = diffuse ? h.spherical_albedo() : h.plane_albedo(1);
      EXPECT_NEAR(result.total[a].value, exact, sigmas * result.total[a].noise) << "albedo " << albedos[a];
      EXPECT_LT(result.total[a].noise, 0.01 * exact);
    }
  }
}

TEST(HalfSpace, SingleScatteringWithoutInterfaceIsItsClosedForm) {
  // Normal incidence, isotropic: albedo / 2 * integral of mu / (1 + mu) = albedo / 2 * (1 - ln 2).
  const HalfSpaceResult result = trace_half_space(normal_incidence(1, {0.3, 1}), {400'000, 42, 0});
  for (std::size_t a : {0, 1})
    EXPECT_NEAR(result.single[a].value, (a ? 1 : 0.3) / 2 * (1 - std::numbers::ln2), sigmas * result.single[a].noise);
}

struct Anchor {
  double eta, albedo, single, multiple;
};

/// Reflectance per transmitted flux at normal incidence, printed with four digits, from a Monte Carlo by other hands.
constexpr Anchor anchors[] = {{1.0, .1, .0154, .0010},   {1.0, .5, .0766, .0385},   {1.0, .8, .1226, .1626},
                              {1.0, .9, .1377, .2770},   {1.0, .95, .1457, .3899},  {1.0, .99, .1521, .6005},
                              {1.0, .999, .1535, .7592}, {1.3, .1, .0076, .0007},   {1.3, .5, .0379, .0257},
                              {1.3, .8, .0605, .1210},   {1.3, .9, .0681, .2226},   {1.3, .95, .0718, .3357},
                              {1.3, .99, .0752, .5816},  {1.3, .999, .0758, .7963}, {1.5, .1, .0053, .0005},
                              {1.5, .5, .0268, .0193},   {1.5, .8, .0431, .0945},   {1.5, .9, .0483, .1805},
                              {1.5, .95, .0509, .2833},  {1.5, .99, .0527, .5327},  {1.5, .999, .0540, .7810}};

TEST(HalfSpace, AgreesWithTheAnchorsOfAnotherMonteCarlo) {
  const std::vector<double> albedos{.1, .5, .8, .9, .95, .99, .999};
  for (double eta : {1.0, 1.3, 1.5}) {
    const HalfSpaceResult result = trace_half_space(normal_incidence(eta, albedos), {1'000'000, 43, 0});
    for (const Anchor& anchor : anchors) {
      if (anchor.eta != eta) continue;
      const std::size_t a = std::find(albedos.begin(), albedos.end(), anchor.albedo) - albedos.begin();
      const double total = anchor.single + anchor.multiple;
      constexpr double last_digit = 1e-4;  // two printed figures, each rounded
      EXPECT_NEAR(result.total[a].value, total, 0.005 * total + last_digit + 3 * result.total[a].noise)
          << "eta " << eta << ", albedo " << anchor.albedo;
      EXPECT_NEAR(result.single[a].value, anchor.single,
                  0.01 * anchor.single + last_digit / 2 + 3 * result.single[a].noise)
          << "eta " << eta << ", albedo " << anchor.albedo;
    }
  }
}

TEST(HalfSpace, ItsTableHoldsForFreshSeeds) {
  const StoredTable table("half_space.json");
  const std::vector<double> albedos = table.head("albedos");
  int compared = 0;
  for (const nlohmann::json& stored : table.cases()) {
    if (++compared % 6 != 1) continue;  // every sixth case: all would take minutes
    HalfSpaceCase setup = normal_incidence(stored["eta"], albedos);
    setup.g = stored["g"];
    setup.incidence.diffuse = stored["incidence"].is_string();
    if (!setup.incidence.diffuse) setup.incidence.cosine = stored["incidence"];
    const HalfSpaceResult result = trace_half_space(setup, {100'000, 45, 0});
    for (std::size_t a = 0; a < albedos.size(); ++a) {
      const double noise = std::hypot(result.total[a].noise, stored["total_noise"][a].get<double>());
      EXPECT_NEAR(result.total[a].value, stored["total"][a].get<double>(), sigmas * noise + 1e-5)
          << "eta " << setup.eta << ", g " << setup.g << ", incidence " << stored["incidence"] << ", albedo "
          << albedos[a];
    }
  }
  EXPECT_GE(compared, 64);
}

}  // namespace
}  // namespace mesograin::referee

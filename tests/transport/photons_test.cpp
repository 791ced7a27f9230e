// Photons through a sphere against the referee, which shares no code; energy in a cube; one answer for a seed.
#include "transport/photons.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "scene/sphere.h"
#include "shapes.h"

namespace mesograin::transport {
namespace {

std::vector<double> totals(const PhotonTally& tally) {
  std::vector<double> shares = tally.sums;
  for (double& share : shares) share /= static_cast<double>(tally.met);
  return shares;
}

TEST(Photons, OfASphereAreTheReferees) {
  std::ifstream file(MESOGRAIN_TEST_DATA "/referee/sphere.json");
  const nlohmann::json table = nlohmann::json::parse(file);
  const std::vector<double> albedos = table["albedos"];
  const Body body(scene::unit_sphere());
  int cases = 0;
  for (const nlohmann::json& entry : table["cases"]) {
    const double radius = entry["radius"];
    if (entry["entry"] != "refracted" || radius > 8.0) continue;
    const Medium medium{radius * body.unit(), 0.0, entry["eta"]};
    const PhotonTally tally = trace_photons(body, medium, {0.3F, 0.5F, 0.8F}, 150'000, albedos.size(),
                                            [&](const Departure& departure, std::span<double> sums) {
                                              if (departure.scatterings == 0) return;
                                              for (std::size_t a = 0; a < albedos.size(); ++a)
                                                sums[a] += std::pow(albedos[a], departure.scatterings);
                                            });
    EXPECT_EQ(tally.lost, 0U);
    const std::vector<double> shares = totals(tally);
    const std::vector<double> truth = entry["scattered_total"];
    for (std::size_t a = 0; a < albedos.size(); ++a)
      EXPECT_NEAR(shares[a], truth[a], 0.006)
          << "eta " << medium.eta << " radius " << radius << " albedo " << albedos[a];
    ++cases;
  }
  EXPECT_GE(cases, 3);
}

TEST(Photons, AreNotLostInACube) {
  const Body body(cube());
  for (const double eta : {1.0, 1.3, 1.5})
    for (const double sigma_t : {1.0, 10.0}) {
      const PhotonTally tally = trace_photons(body, {sigma_t, 0.5, eta}, {0.5F, 0.5F, 0.7F}, 60'000, 1,
                                              [](const Departure&, std::span<double> sums) { sums[0] += 1.0; });
      const double mirrored =
          totals(trace_photons(body, {1e-6, 0.0, eta}, {0.5F, 0.5F, 0.7F}, 60'000, 1,
                               [](const Departure&, std::span<double> sums) { sums[0] += 1.0; }))[0];
      EXPECT_EQ(tally.lost, 0U);
      // All that enters leaves, whatever happens inside.
      EXPECT_NEAR(totals(tally)[0], mirrored, 0.004) << eta << " " << sigma_t;
    }
}

TEST(Photons, DependOnTheSeedAloneNotOnThreads) {
  const Body body(cube());
  const auto trace = [&](std::uint64_t seed, unsigned threads) {
    Effort effort;
    effort.seed = seed;
    effort.threads = threads;
    return trace_photons(
               body, {5.0, 0.0, 1.3}, {0.5F, 0.5F, 0.7F}, 20'000, 3,
               [](const Departure& departure, std::span<double> sums) {
                 for (int i = 0; i < 3; ++i) sums[i] += std::abs(departure.place[i]);
               },
               effort)
        .sums;
  };
  EXPECT_EQ(trace(7, 1), trace(7, 3));
  EXPECT_NE(trace(7, 1), trace(8, 1));
}

TEST(Photons, StopWhenAskedTo) {
  const Body body(cube());
  std::atomic<bool> stop{false};
  double furthest = 0.0;
  Effort effort;
  effort.stop = &stop;
  effort.progress = [&](double share) {
    furthest = share;
    if (share > 0.2) stop = true;
  };
  EXPECT_THROW(trace_photons(
                   body, {5.0, 0.0, 1.3}, {0.5F, 0.5F, 0.7F}, 1'000'000, 1,
                   [](const Departure&, std::span<double> sums) { sums[0] += 1.0; }, effort),
               Stopped);
  EXPECT_GT(furthest, 0.2);
  EXPECT_LT(furthest, 0.5);
}

}  // namespace
}  // namespace mesograin::transport

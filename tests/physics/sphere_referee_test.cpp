// The sphere's solution against photon Monte Carlo: over the surface, in total, and on the dark side.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "physics/body/entering_ring.h"
#include "physics/body/sphere_exitance.h"

namespace mesograin::physics {
namespace {

std::vector<double> bin_cosines(int bins) {
  std::vector<double> cosines;
  cosines.reserve(static_cast<std::size_t>(bins));
  for (int i = 0; i < bins; ++i) cosines.push_back((2.0 * i + 1.0) / bins - 1.0);
  return cosines;
}

struct Comparison {
  double error = 0.0;
  double dark_error = 0.0;
  double dark_noise = 0.0;
};

Comparison compare(const std::vector<double>& model, const std::vector<double>& truth, const std::vector<double>& noise,
                   const std::vector<double>& cosines) {
  double difference = 0.0, sum = 0.0, dark_difference = 0.0, dark_noise = 0.0, dark_sum = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    difference += std::abs(model[i] - truth[i]);
    sum += truth[i];
    if (cosines[i] >= -0.5) continue;
    dark_difference += std::abs(model[i] - truth[i]);
    dark_noise += noise[i];
    dark_sum += truth[i];
  }
  return {difference / sum, dark_difference / dark_sum, dark_noise / dark_sum};
}

TEST(SphereExitance, IsThatOfThePhotonsThatWereTraced) {
  std::ifstream file(MESOGRAIN_TEST_DATA "/referee/sphere.json");
  const nlohmann::json table = nlohmann::json::parse(file);
  const std::vector<double> albedos = table["albedos"];
  const std::vector<double> cosines = bin_cosines(table["bins"]);
  int dark_sides = 0;
  for (const nlohmann::json& entry : table["cases"]) {
    if (entry["entry"] != "refracted") continue;
    const double eta = entry["eta"];
    const double radius = entry["radius"];
    const BodySurface surface{eta, false, diffusion_boundary(eta)};
    const std::vector<double> single = SphereSingleScattering(eta, 0.0, cosines).exitance({0.0, radius, 0.0});
    double mean = 0.0;
    for (std::size_t a = 0; a < albedos.size(); ++a) {
      std::vector<double> model =
          sphere_multiple_exitance({(1.0 - albedos[a]) * radius, albedos[a] * radius, 0.0}, surface, cosines);
      for (std::size_t i = 0; i < model.size(); ++i) model[i] += albedos[a] * single[i];
      const Comparison result = compare(model, entry["scattered"][a], entry["scattered_noise"][a], cosines);
      mean += result.error / static_cast<double>(albedos.size());
      // Internal reflection of the beam that a small dense grain does not scatter is what is missing most.
      EXPECT_LT(result.error, radius < 1.0 && eta > 1.5 ? 0.08 : 0.06) << eta << ' ' << radius << ' ' << albedos[a];
      if (radius > 8.0 || result.dark_noise > 0.1) continue;
      EXPECT_LT(result.dark_error, 0.5) << eta << ' ' << radius << ' ' << albedos[a];
      ++dark_sides;
    }
    EXPECT_LT(mean, 0.05) << eta << ' ' << radius;
    RecordProperty("mean_l1_eta" + std::to_string(eta) + "_radius" + std::to_string(radius), std::to_string(mean));
  }
  EXPECT_GT(dark_sides, 100);
}

// The less diffusion can tell, the longer light keeps its direction.
const std::map<double, double> largest_mean_error{{-0.5, 0.09}, {0.3, 0.05}, {0.6, 0.08}, {0.85, 0.14}, {0.95, 0.2}};

TEST(SphereExitance, IsThatOfThePhotonsWhereScatteringIsNotIsotropic) {
  std::ifstream file(MESOGRAIN_TEST_DATA "/referee/sphere_anisotropic.json");
  const nlohmann::json table = nlohmann::json::parse(file);
  const std::vector<double> albedos = table["albedos"];
  const std::vector<double> cosines = bin_cosines(table["bins"]);
  std::map<double, std::vector<double>> errors;
  for (const nlohmann::json& entry : table["cases"]) {
    if (entry["entry"] != "refracted") continue;
    const double eta = entry["eta"];
    const double radius = entry["radius"];
    const double g = entry["g"];
    const BodySurface surface{eta, false, diffusion_boundary(eta)};
    const SphereSingleScattering single(eta, g, cosines);
    for (std::size_t a = 0; a < albedos.size(); ++a) {
      const BodyMedium medium{(1.0 - albedos[a]) * radius, albedos[a] * radius, g};
      const std::vector<double> once = single.exitance(medium);
      std::vector<double> model = sphere_multiple_exitance(medium, surface, cosines);
      for (std::size_t i = 0; i < model.size(); ++i) model[i] += once[i];
      const Comparison result = compare(model, entry["scattered"][a], entry["scattered_noise"][a], cosines);
      errors[g].push_back(result.error);
      // In the thinnest, light is scattered hardly twice, and once is exact but for what is reflected inside.
      EXPECT_LT(result.error, radius > 1.0 ? 0.5
                              : eta > 1.0  ? 0.2
                                           : 0.07)
          << g << ' ' << eta << ' ' << radius << ' ' << albedos[a];
    }
  }
  ASSERT_EQ(errors.size(), largest_mean_error.size());
  for (const auto& [g, some] : errors) {
    EXPECT_EQ(some.size(), 30u);
    EXPECT_LT(std::accumulate(some.begin(), some.end(), 0.0) / static_cast<double>(some.size()),
              largest_mean_error.at(g))
        << g;
  }
}

TEST(SphereUnscattered, IsThatOfThePhotonsThatCrossed) {
  std::ifstream file(MESOGRAIN_TEST_DATA "/referee/sphere.json");
  const nlohmann::json table = nlohmann::json::parse(file);
  const std::vector<double> cosines = bin_cosines(table["bins"]);
  const SphereUnscattered unscattered({1.0, true, diffusion_boundary(1.0)}, cosines);
  int spheres = 0;
  for (const nlohmann::json& entry : table["cases"]) {
    if (entry["entry"] != "lambert") continue;
    const std::vector<double> model = unscattered.exitance(entry["radius"]);
    for (std::size_t i = 0; i < model.size(); ++i)
      EXPECT_NEAR(model[i], entry["ballistic"][i], 5.0 * entry["ballistic_noise"][i].get<double>() + 1e-5)
          << entry["radius"] << ' ' << cosines[i];
    ++spheres;
  }
  EXPECT_EQ(spheres, 5);
}

TEST(SphereUnscattered, IsAllOfTheLightWhereNothingIsInTheWay) {
  const SphereUnscattered unscattered({1.0, true, diffusion_boundary(1.0)}, {-1.0, -0.3, 0.0, 0.7, 1.0});
  for (const double exitance : unscattered.exitance(0.0)) EXPECT_NEAR(exitance, 0.25, 2.5e-4);
}

}  // namespace
}  // namespace mesograin::physics

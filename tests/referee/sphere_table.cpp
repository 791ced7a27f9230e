// sphere.json and sphere_anisotropic.json: a sphere's exitance over material, eta and radius, the truth of the accuracy
// tables.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "sphere.h"
#include "table_file.h"
#include "tables.h"

namespace mesograin::referee {
namespace {

struct Substance {
  std::string name;
  std::array<double, 3> sigma_s, sigma_a;

  double albedo(std::size_t channel) const { return sigma_s[channel] / (sigma_s[channel] + sigma_a[channel]); }
};

/// The last five: reduced coefficients of Jensen et al., "A practical model for subsurface light transport", 2001,
/// figure 5 (1/mm).
const std::vector<Substance> substances{
    {"0.9/0.1", {0.9, 0.9, 0.9}, {0.1, 0.1, 0.1}},          {"0.5/0.5", {0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}},
    {"0.1/0.9", {0.1, 0.1, 0.1}, {0.9, 0.9, 0.9}},          {"0.8/0.2", {0.8, 0.8, 0.8}, {0.2, 0.2, 0.2}},
    {"1/0.001", {1, 1, 1}, {0.001, 0.001, 0.001}},          {"apple", {2.29, 2.39, 1.97}, {0.0030, 0.0034, 0.046}},
    {"chicken1", {0.15, 0.21, 0.38}, {0.015, 0.077, 0.19}}, {"marble", {2.19, 2.62, 3.00}, {0.0021, 0.0041, 0.0071}},
    {"skin1", {0.74, 0.88, 1.01}, {0.032, 0.17, 0.48}},     {"wholemilk", {2.55, 3.21, 3.77}, {0.0011, 0.0024, 0.014}},
};

std::vector<double> distinct_albedos() {
  std::vector<double> albedos;
  for (const Substance& substance : substances)
    for (std::size_t channel = 0; channel < 3; ++channel) albedos.push_back(substance.albedo(channel));
  std::sort(albedos.begin(), albedos.end());
  albedos.erase(std::unique(albedos.begin(), albedos.end(), [](double a, double b) { return b - a < 1e-9; }),
                albedos.end());
  return albedos;
}

nlohmann::json head(const std::vector<double>& albedos, int bins) {
  nlohmann::json materials = nlohmann::json::array();
  for (const Substance& substance : substances) {
    nlohmann::json indices = nlohmann::json::array();
    for (std::size_t channel = 0; channel < 3; ++channel)
      indices.push_back(std::lower_bound(albedos.begin(), albedos.end(), substance.albedo(channel) - 1e-9) -
                        albedos.begin());
    materials.push_back({{"name", substance.name},
                         {"sigma_s", substance.sigma_s},
                         {"sigma_a", substance.sigma_a},
                         {"albedo_index", indices}});
  }
  return {{"about",
           "Photon Monte Carlo of a sphere in parallel light, isotropic scattering. radius: in mean free paths. entry: "
           "refracted (smooth "
           "interface of index eta, straight on at eta 1) or lambert (index-matched, cosine lobe below the surface). "
           "Exitances "
           "(ballistic: order 0; unit_single: order 1 at albedo 1, to be multiplied by the albedo; scattered: orders "
           ">= 1, one row an "
           "albedo) are flux per area for unit irradiance on a plane that faces the light, by bins of cos(normal, "
           "light), equal widths "
           "from -1 to 1. Totals are per flux incident on the sphere; dark_total: orders >= 1 leaving at cosines below "
           "-1/2; specular: "
           "reflected at entry. *_noise: standard error (0 where no photon came). albedo_index: of the material's red, "
           "green, blue. "
           "Made by: mesograin-referee tables"},
          {"albedos", albedos},
          {"bins", bins},
          {"materials", materials},
          {"seed", 20012}};
}

nlohmann::json trace(const SphereCase& setup, const Effort& effort) {
  const SphereResult result = trace_sphere(setup, effort);
  nlohmann::json scattered = nlohmann::json::array(), scattered_noise = nlohmann::json::array();
  for (const auto& row : result.scattered) {
    scattered.push_back(values(row));
    scattered_noise.push_back(noises(row));
  }
  return {{"specular", rounded(result.specular.value)},
          {"ballistic", values(result.ballistic)},
          {"ballistic_noise", noises(result.ballistic)},
          {"ballistic_total", rounded(result.ballistic_total.value)},
          {"unit_single", values(result.unit_single)},
          {"unit_single_noise", noises(result.unit_single)},
          {"unit_single_total", rounded(result.unit_single_total.value)},
          {"unit_single_total_noise", rounded(result.unit_single_total.noise)},
          {"scattered", scattered},
          {"scattered_noise", scattered_noise},
          {"scattered_total", values(result.scattered_total)},
          {"scattered_total_noise", noises(result.scattered_total)},
          {"dark_total", values(result.dark_total)},
          {"dark_total_noise", noises(result.dark_total)}};
}

}  // namespace

void make_sphere_table(const std::filesystem::path& directory, unsigned threads) {
  const std::vector<double> albedos = distinct_albedos();
  std::vector<TableCase> cases;
  const auto add = [&](double eta, double radius, Entry entry) {
    const SphereCase setup{.radius = radius, .eta = eta, .g = 0, .entry = entry, .albedos = albedos};
    const std::uint64_t photons = radius > 20 ? 12'000'000 : 24'000'000;
    const nlohmann::json key{{"eta", eta},
                             {"radius", radius},
                             {"entry", entry == Entry::lambert ? "lambert" : "refracted"},
                             {"photons", photons}};
    cases.push_back({key, static_cast<double>(photons) * eta * (1 + std::min(radius, 30.0) / 8), [=] {
                       return trace(setup, {photons, 20012, threads});
                     }});
  };
  for (double eta : {1.3, 1.0, 1.6})
    for (double radius : {2.4, 7.2, 14.4, 0.6, 48.0}) add(eta, radius, Entry::refracted);
  for (double radius : {2.4, 7.2, 14.4, 0.6, 48.0}) add(1, radius, Entry::lambert);
  fill_table(directory / "sphere.json", head(albedos, SphereCase{}.bins), cases);
}

void make_anisotropic_sphere_table(const std::filesystem::path& directory, unsigned threads) {
  const std::vector<double> albedos{0.5, 0.9, 0.999};
  constexpr std::uint64_t seed = 20013;
  const nlohmann::json head{{"about",
                             "Photon Monte Carlo of a sphere in parallel light, Henyey-Greenstein scattering of mean "
                             "cosine g, smooth interface of index eta. radius: in mean free paths, not reduced ones. "
                             "The rest as in sphere.json. Made by: mesograin-referee tables"},
                            {"albedos", albedos},
                            {"bins", SphereCase{}.bins},
                            {"seed", seed}};
  std::vector<TableCase> cases;
  const auto add = [&](double g, double eta, double radius, Entry entry) {
    const SphereCase setup{.radius = radius, .eta = eta, .g = g, .entry = entry, .albedos = albedos};
    const std::uint64_t photons = radius > 20 ? 1'000'000 : 4'000'000;
    const nlohmann::json key{{"g", g},
                             {"eta", eta},
                             {"radius", radius},
                             {"entry", entry == Entry::lambert ? "lambert" : "refracted"},
                             {"photons", photons}};
    cases.push_back({key, static_cast<double>(photons) * eta * (1 + radius), [=] {
                       return trace(setup, {photons, seed, threads});
                     }});
  };
  for (double g : {0.6, -0.5, 0.3, 0.85, 0.95})
    for (double radius : {0.6, 2.4, 7.2, 14.4, 48.0}) {
      for (double eta : {1.0, 1.3}) add(g, eta, radius, Entry::refracted);
      if (g == 0.6 || g == 0.85) add(g, 1, radius, Entry::lambert);
    }
  fill_table(directory / "sphere_anisotropic.json", head, cases);
}

}  // namespace mesograin::referee

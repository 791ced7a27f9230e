// half_space.json: the half-space's reflectance over albedo, eta and incidence, the oracle of the half-space theories.
#include <cmath>

#include "half_space.h"
#include "table_file.h"
#include "tables.h"

namespace mesograin::referee {
namespace {

const std::vector<double> albedos{0.05, 0.1,  0.2,  0.3,  0.4,   0.5,   0.6,   0.7,    0.8,    0.85,  0.9,
                                  0.95, 0.97, 0.98, 0.99, 0.995, 0.998, 0.999, 0.9995, 0.9998, 0.9999};
constexpr int lobe_bins = 10;
constexpr std::uint64_t photons = 2'000'000;
constexpr std::uint64_t seed = 20011;

const nlohmann::json head{{"about",
                           "Photon Monte Carlo of a half-space with a smooth interface (eta = index inside / outside), "
                           "per unit of transmitted flux. "
                           "single: order 1; multiple: orders >= 2; total: both; *_noise: standard error; lobe: total "
                           "by bins of the cosine outside "
                           "(equal widths from 0 to 1), for the albedos of lobe_albedos. incidence: cosine of a "
                           "collimated beam outside, or diffuse "
                           "(cosine-weighted outside). Lists run over albedos. Made by: mesograin-referee tables"},
                          {"albedos", albedos},
                          {"lobe_albedos", {0.5, 0.9, 0.99}},
                          {"photons", photons},
                          {"seed", seed}};

nlohmann::json trace(double eta, double g, double cosine, bool diffuse, unsigned threads) {
  const HalfSpaceCase setup{
      .eta = eta, .g = g, .incidence = {cosine, diffuse}, .albedos = albedos, .radii = {}, .lobe_bins = lobe_bins};
  const HalfSpaceResult result = trace_half_space(setup, {photons, seed, threads});
  nlohmann::json lobe = nlohmann::json::array(), lobe_noise = nlohmann::json::array();
  for (double albedo : head["lobe_albedos"]) {
    const auto a = std::find(albedos.begin(), albedos.end(), albedo) - albedos.begin();
    lobe.push_back(values(result.lobe[a]));
    lobe_noise.push_back(noises(result.lobe[a]));
  }
  return {{"single", values(result.single)},
          {"single_noise", noises(result.single)},
          {"multiple", values(result.multiple)},
          {"multiple_noise", noises(result.multiple)},
          {"total", values(result.total)},
          {"total_noise", noises(result.total)},
          {"lobe", lobe},
          {"lobe_noise", lobe_noise}};
}

}  // namespace

void make_half_space_table(const std::filesystem::path& directory, unsigned threads) {
  std::vector<TableCase> cases;
  const auto add = [&](double eta, double g, double cosine, bool diffuse) {
    if (!diffuse && (1 - cosine * cosine) / (eta * eta) >= 1) return;  // total reflection: nothing is transmitted
    nlohmann::json key{{"eta", eta}, {"g", g}};
    if (diffuse)
      key["incidence"] = "diffuse";
    else
      key["incidence"] = cosine;
    cases.push_back({key, std::max(1.0, eta), [=] { return trace(eta, g, cosine, diffuse, threads); }});
  };
  for (double g : {-0.5, 0.5, 0.8})
    for (double eta : {1.0, 1.3}) add(eta, g, 1, false);
  for (double eta : {1.0, 1.3, 1.5, 1.6, 1.1, 1.2, 1.4, 1.8, 2.0, 2.5, 0.75, 0.5, 3.0}) {
    add(eta, 0, 1, false);
    add(eta, 0, 1, true);
    for (double cosine : {0.7, 0.4, 0.1}) add(eta, 0, cosine, false);
  }
  fill_table(directory / "half_space.json", head, cases);
}

}  // namespace mesograin::referee

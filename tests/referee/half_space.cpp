// Traces a half-space: one conservative walk a photon, weighed for every albedo.
#include "half_space.h"

#include <algorithm>
#include <cmath>

#include "albedos.h"
#include "walk.h"

namespace mesograin::referee {
namespace {

struct Visitor {
  const HalfSpaceCase& setup;
  const AlbedoPowers& powers;
  std::span<double> tally;

  void scattered(const glm::dvec3&, const glm::dvec3&, int, double) {}

  void left(const glm::dvec3& position, const glm::dvec3& normal, const glm::dvec3& direction, int order,
            double weight) {
    const std::size_t albedos = powers.count();
    double* totals = tally.data();
    powers.add(weight, order, totals + (order == 1 ? 0 : albedos));
    powers.add(weight, order, totals + 2 * albedos);
    double* next = totals + 3 * albedos;
    if (!setup.radii.empty()) {
      const double radius = std::hypot(position.x, position.y);
      const auto edge = std::upper_bound(setup.radii.begin(), setup.radii.end(), radius);
      if (edge != setup.radii.end()) powers.add(weight, order, next + (edge - setup.radii.begin() - 1) * albedos);
      next += (setup.radii.size() - 1) * albedos;
    }
    if (setup.lobe_bins > 0) {
      const double inside = glm::dot(direction, normal);
      const double outside = std::sqrt(std::max(0.0, 1 - setup.eta * setup.eta * (1 - inside) * (1 + inside)));
      const int bin = std::min(static_cast<int>(outside * setup.lobe_bins), setup.lobe_bins - 1);
      powers.add(weight, order, next + bin * albedos);
    }
  }
};

}  // namespace

HalfSpaceResult trace_half_space(const HalfSpaceCase& setup, const Effort& effort) {
  const Interface interface { setup.eta };
  const AlbedoPowers powers(setup.albedos);
  const std::size_t albedos = setup.albedos.size();
  const std::size_t rings = setup.radii.empty() ? 0 : setup.radii.size() - 1;
  const auto estimates = run_batches(
      effort, (3 + rings + setup.lobe_bins) * albedos, [&](Rng& rng, std::uint64_t photons, std::span<double> tally) {
        Visitor visitor{setup, powers, tally};
        for (std::uint64_t i = 0; i < photons; ++i)
          walk(HalfSpace{}, interface, Medium{1, setup.g}, setup.incidence.enter(interface, rng), rng, visitor);
      });

  HalfSpaceResult result;
  const auto row = [&](std::size_t index) {
    return std::vector<Estimate>(estimates.begin() + index * albedos, estimates.begin() + (index + 1) * albedos);
  };
  const auto transposed = [&](std::size_t first, std::size_t bins) {
    std::vector<std::vector<Estimate>> columns(albedos, std::vector<Estimate>(bins));
    for (std::size_t bin = 0; bin < bins; ++bin)
      for (std::size_t a = 0; a < albedos; ++a) columns[a][bin] = estimates[(first + bin) * albedos + a];
    return columns;
  };
  result.single = row(0);
  result.multiple = row(1);
  result.total = row(2);
  result.profile = transposed(3, rings);
  result.lobe = transposed(3 + rings, setup.lobe_bins);
  return result;
}

}  // namespace mesograin::referee

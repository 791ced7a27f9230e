// Traces a slab: one conservative walk a photon, weighed for every albedo.
#include "slab.h"

#include "albedos.h"
#include "walk.h"

namespace mesograin::referee {
namespace {

struct Visitor {
  const AlbedoPowers& powers;
  std::span<double> tally;

  static std::size_t side_size(const AlbedoPowers& powers) { return 1 + 2 * powers.count(); }

  void scattered(const glm::dvec3&, const glm::dvec3&, int, double) {}

  void left(const glm::dvec3&, const glm::dvec3& normal, const glm::dvec3&, int order, double weight) {
    double* side = tally.data() + (normal.z > 0 ? side_size(powers) : 0);
    if (order == 0) {
      side[0] += weight;
      return;
    }
    if (order == 1) powers.add(weight, order, side + 1);
    powers.add(weight, order, side + 1 + powers.count());
  }
};

}  // namespace

SlabResult trace_slab(const SlabCase& setup, const Effort& effort) {
  const Interface interface { setup.eta };
  const AlbedoPowers powers(setup.albedos);
  const std::size_t side_size = Visitor::side_size(powers);
  const auto estimates =
      run_batches(effort, 2 * side_size, [&](Rng& rng, std::uint64_t photons, std::span<double> tally) {
        Visitor visitor{powers, tally};
        for (std::uint64_t i = 0; i < photons; ++i)
          walk(Slab{setup.thickness}, interface, Medium{1, setup.g}, setup.incidence.enter(interface, rng), rng,
               visitor);
      });
  const auto side = [&](std::size_t first) {
    const auto singles = estimates.begin() + first + 1;
    const auto scattered = singles + powers.count();
    return SlabSide{estimates[first], {singles, scattered}, {scattered, scattered + powers.count()}};
  };
  return {side(0), side(side_size)};
}

}  // namespace mesograin::referee

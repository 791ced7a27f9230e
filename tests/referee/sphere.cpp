// Traces a sphere: impact parameters are stratified, the walk is conservative and weighed for every albedo.
#include "sphere.h"

#include <algorithm>
#include <cmath>

#include "albedos.h"
#include "walk.h"

namespace mesograin::referee {
namespace {

/// Where each sum of a batch lies: the profiles that are tallied, then the totals made of them.
struct Layout {
  std::size_t bins, albedos;

  std::size_t ballistic(std::size_t bin) const { return bin; }
  std::size_t single(std::size_t bin) const { return bins + bin; }
  std::size_t scattered(std::size_t bin) const { return 2 * bins + bin * albedos; }
  std::size_t specular_total() const { return (2 + albedos) * bins; }
  std::size_t ballistic_total() const { return specular_total() + 1; }
  std::size_t single_total() const { return specular_total() + 2; }
  std::size_t scattered_total() const { return specular_total() + 3; }
  std::size_t dark_total() const { return scattered_total() + albedos; }
  std::size_t size() const { return dark_total() + albedos; }

  void add_up_totals(std::span<double> tally) const {
    for (std::size_t bin = 0; bin < bins; ++bin) {
      tally[ballistic_total()] += tally[ballistic(bin)];
      tally[single_total()] += tally[single(bin)];
      for (std::size_t a = 0; a < albedos; ++a) {
        tally[scattered_total() + a] += tally[scattered(bin) + a];
        if (4 * (bin + 1) <= bins) tally[dark_total() + a] += tally[scattered(bin) + a];
      }
    }
  }
};

struct Visitor {
  const Layout& layout;
  const AlbedoPowers& powers;
  std::span<double> tally;

  void scattered(const glm::dvec3&, const glm::dvec3&, int, double) {}

  void left(const glm::dvec3&, const glm::dvec3& normal, const glm::dvec3&, int order, double weight) {
    const double place = 0.5 * (normal.z + 1) * static_cast<double>(layout.bins);
    const std::size_t bin = std::min(static_cast<std::size_t>(std::max(0.0, place)), layout.bins - 1);
    if (order == 0) {
      tally[layout.ballistic(bin)] += weight;
      return;
    }
    if (order == 1) tally[layout.single(bin)] += weight;
    powers.add(weight, order, &tally[layout.scattered(bin)]);
  }
};

/// Light travels towards -z; `square` is the squared impact parameter over the squared radius.
Photon enter(const SphereCase& setup, const Interface& interface, double square, Rng& rng) {
  const double cosine = std::sqrt(1 - square);
  const glm::dvec3 normal(std::sqrt(square), 0, cosine);
  Photon photon{setup.radius * normal, {0, 0, -1}, 1};
  if (setup.entry == Entry::lambert) {
    photon.direction = sample_cosine(-normal, rng);
  } else if (!interface.matched()) {
    photon.weight = 1 - interface.reflectance_from_outside(cosine);
    if (photon.weight > 0) photon.direction = refract(photon.direction, normal, interface.eta);
  }
  return photon;
}

}  // namespace

SphereResult trace_sphere(const SphereCase& setup, const Effort& effort) {
  const Interface interface { setup.eta };
  const AlbedoPowers powers(setup.albedos);
  const Layout layout{static_cast<std::size_t>(setup.bins), setup.albedos.size()};
  const auto estimates =
      run_batches(effort, layout.size(), [&](Rng& rng, std::uint64_t photons, std::span<double> tally) {
        Visitor visitor{layout, powers, tally};
        for (std::uint64_t i = 0; i < photons; ++i) {
          const double square = (static_cast<double>(i) + rng.uniform()) / static_cast<double>(photons);
          const Photon photon = enter(setup, interface, square, rng);
          tally[layout.specular_total()] += 1 - photon.weight;
          if (photon.weight > 0) walk(Sphere{setup.radius}, interface, Medium{1, setup.g}, photon, rng, visitor);
        }
        layout.add_up_totals(tally);
      });

  SphereResult result;
  const double exitance = 0.25 * setup.bins;  // pi R^2 of incident flux over the bin's area of 4 pi R^2 / bins
  const auto scaled = [&](std::size_t index) {
    return Estimate{exitance * estimates[index].value, exitance * estimates[index].noise};
  };
  result.scattered.resize(layout.albedos);
  for (std::size_t bin = 0; bin < layout.bins; ++bin) {
    result.ballistic.push_back(scaled(layout.ballistic(bin)));
    result.unit_single.push_back(scaled(layout.single(bin)));
    for (std::size_t a = 0; a < layout.albedos; ++a) result.scattered[a].push_back(scaled(layout.scattered(bin) + a));
  }
  result.specular = estimates[layout.specular_total()];
  result.ballistic_total = estimates[layout.ballistic_total()];
  result.unit_single_total = estimates[layout.single_total()];
  for (std::size_t a = 0; a < layout.albedos; ++a) {
    result.scattered_total.push_back(estimates[layout.scattered_total() + a]);
    result.dark_total.push_back(estimates[layout.dark_total() + a]);
  }
  return result;
}

}  // namespace mesograin::referee

// One photon after another, from the sun until it leaves.
#include "transport/photons.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "physics/physics.h"
#include "transport/directions.h"
#include "transport/incidence.h"
#include "transport/random.h"

namespace mesograin::transport {
namespace {

constexpr std::uint64_t photons_a_piece = 4096;

// A walk in a clear corner that reflects totally for ever is given up.
constexpr int most_steps = 1 << 20;

/// From just inside the surface to where it leaves; nothing if it never does.
std::optional<Departure> walk(const Body& body, const Medium& medium, glm::vec3 place, glm::vec3 direction,
                              Random& random) {
  const auto mean_free_path = static_cast<float>(1.0 / medium.sigma_t);
  const auto eta = static_cast<float>(medium.eta);
  const auto g = static_cast<float>(medium.g);
  int scatterings = 0;
  float flight = -std::log1p(-random.uniform()) * mean_free_path;
  for (int step = 0; step < most_steps; ++step) {
    const std::optional<Hit> hit = body.first_hit(place, direction);
    // Rounding may put a place that lies on an edge outside.
    if (!hit || glm::dot(hit->normal, direction) <= 0.0F) return Departure{place, direction, direction, scatterings};
    if (flight < hit->distance) {
      place += flight * direction;
      direction = scattered(direction, g, random.uniform(), random.uniform());
      flight = -std::log1p(-random.uniform()) * mean_free_path;
      ++scatterings;
      continue;
    }
    place += hit->distance * direction;
    flight -= hit->distance;
    const float cosine = std::min(glm::dot(hit->normal, direction), 1.0F);
    if (medium.eta == 1.0 || random.uniform() >= physics::fresnel_reflectance(cosine, 1.0 / medium.eta)) {
      const glm::vec3 outside = medium.eta == 1.0 ? direction : refracted(direction, -hit->normal, 1.0F / eta);
      return Departure{place, outside, hit->normal, scatterings};
    }
    direction = glm::normalize(direction - 2.0F * cosine * hit->normal);
  }
  return std::nullopt;
}

}  // namespace

PhotonTally trace_photons(const Body& body, const Medium& medium, const glm::vec3& to_light, std::uint64_t photons,
                          std::size_t tally_size, const std::function<void(const Departure&, std::span<double>)>& add,
                          const Effort& effort) {
  const Incidence incidence(body, to_light);
  const std::uint64_t pieces = (photons + photons_a_piece - 1) / photons_a_piece;
  std::vector<PhotonTally> tallies(pieces);
  run_pieces(effort, pieces, [&](std::size_t piece) {
    PhotonTally tally{std::vector<double>(tally_size)};
    Random random(effort.seed, piece);
    const std::uint64_t end = std::min(photons, (piece + 1) * photons_a_piece);
    for (std::uint64_t photon = piece * photons_a_piece; photon < end; ++photon) {
      const glm::vec3 start = incidence.start(random.uniform(), random.uniform());
      const std::optional<Hit> hit = body.first_hit(start, -incidence.to_light());
      if (!hit) continue;
      ++tally.met;
      const float cosine = std::clamp(glm::dot(hit->normal, incidence.to_light()), 0.0F, 1.0F);
      if (medium.eta != 1.0 && random.uniform() < physics::fresnel_reflectance(cosine, medium.eta)) continue;
      const glm::vec3 place = start - hit->distance * incidence.to_light();
      const glm::vec3 inwards = medium.eta == 1.0
                                    ? -incidence.to_light()
                                    : refracted(-incidence.to_light(), hit->normal, static_cast<float>(medium.eta));
      const std::optional<Departure> departure = walk(body, medium, place, inwards, random);
      if (departure)
        add(*departure, tally.sums);
      else
        ++tally.lost;
    }
    tallies[piece] = std::move(tally);
  });
  PhotonTally all{std::vector<double>(tally_size)};
  for (const PhotonTally& tally : tallies) {
    for (std::size_t i = 0; i < tally_size; ++i) all.sums[i] += tally.sums[i];
    all.met += tally.met;
    all.lost += tally.lost;
  }
  return all;
}

}  // namespace mesograin::transport

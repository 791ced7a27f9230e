// Rays from the sun leave the lengths of their ways in the cells that they pass.
#include "mesh_light.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "directions.h"
#include "parallel.h"
#include "view.h"

namespace mesograin::referee {
namespace {

// So that the light hardly changes within a cell, and a picture's block still sees many of them.
constexpr double widest = 0.15;  // mean free paths
constexpr int fewest = 48, most = 224, most_with_directions = 64;
constexpr int rays_a_batch_across = 400;
constexpr double least_power = 1e-4;

double wanted(const MeshBody& body, bool directions) {
  const glm::dvec3 extent = body.upper() - body.lower();
  const double longest = std::max({extent.x, extent.y, extent.z});
  return std::clamp(longest / widest, 1.0 * fewest, directions ? 1.0 * most_with_directions : 1.0 * most);
}

}  // namespace

MeshLight::MeshLight(const MeshBody& body, const RoughInterface& interface, const scene::DirectionalLight& sun,
                     bool directions, std::uint64_t seed, unsigned threads)
    : cells_(body, wanted(body, directions)), parts_(batches_) {
  const std::size_t cells = cells_.count();
  parallel(batches_, threads, [&](std::size_t i) {
    Rng rng(seed ^ 0x5eedULL, i);
    parts_[i].tracks.resize(cells);
    if (directions) parts_[i].directions.resize(kept_ * cells);
    trace(body, interface, sun, rng, parts_[i]);
  });
  const std::vector<double> inside = cells_.volumes(body);
  fluence_.resize(cells);
  for (std::size_t i = 0; i < cells; ++i) {
    double sum = 0;
    for (const Batch& batch : parts_) sum += batch.tracks[i];
    fluence_[i] = inside[i] > 0 ? static_cast<float>(sum / batches_ / inside[i]) : 0;
  }
  if (!directions) parts_.clear();
}

double MeshLight::fluence(const glm::dvec3& place) const { return fluence_[cells_.at(place)]; }

glm::dvec3 MeshLight::direction(const glm::dvec3& place, Rng& rng) const {
  const std::size_t at = cells_.at(place);
  double sum = 0;
  for (const Batch& batch : parts_) sum += batch.tracks[at];
  double choice = rng.uniform() * sum;
  for (const Batch& batch : parts_) {
    choice -= batch.tracks[at];
    if (choice < 0) return batch.directions[kept_ * at + static_cast<std::size_t>(kept_ * rng.uniform())];
  }
  return {0, 0, 1};
}

void MeshLight::trace(const MeshBody& body, const RoughInterface& interface, const scene::DirectionalLight& sun,
                      Rng& rng, Batch& batch) const {
  std::vector<float> kept_weights(batch.directions.empty() ? 0 : batch.tracks.size());
  const glm::dvec3 middle = 0.5 * (body.lower() + body.upper());
  const double reach = 0.5 * glm::distance(body.lower(), body.upper());
  constexpr int across = rays_a_batch_across;
  for (int i = 0; i < across * across; ++i) {
    const glm::dvec3 to_light = sample_sun(sun, rng);
    glm::dvec3 first, second;
    frame(to_light, first, second);
    const double u = 2 * (i % across + rng.uniform()) / across - 1;
    const int row = i / across;
    const double v = 2 * (row + rng.uniform()) / across - 1;
    glm::dvec3 place = middle + reach * (u * first + v * second + 1.5 * to_light), direction = -to_light;
    double power = 4 * reach * reach / (1.0 * across * across), left = 1;
    while (const std::optional<MeshHit> hit = body.first_hit(place, direction)) {
      if (glm::dot(hit->normal, direction) > 0) {
        cells_.follow(place, direction, hit->distance, [&](std::size_t at, double begin, double end) {
          const auto weight = static_cast<float>(power * left * std::exp(-begin) * -std::expm1(begin - end));
          batch.tracks[at] += weight;
          if (batch.directions.empty()) return;
          kept_weights[at] += weight;
          for (std::size_t slot = 0; slot < kept_; ++slot)
            if (rng.uniform() * kept_weights[at] <= weight) batch.directions[kept_ * at + slot] = direction;
        });
        left *= std::exp(-hit->distance);
        if (left < least_power) break;
      }
      place += hit->distance * direction;
      direction = interface.beyond(direction, hit->normal, rng);
    }
  }
}

}  // namespace mesograin::referee

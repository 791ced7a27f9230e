// Rays from a light leave the lengths of their ways in the cells that they pass, and themselves where they are
// scattered.
#include "unscattered_light.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "light_source.h"
#include "parallel.h"

namespace mesograin::referee {
namespace {

constexpr std::size_t batches = 2;
constexpr double widest_cell = 0.15;  // mean free paths
constexpr double fewest_across = 12, most_across = 96;
constexpr double most_numbers = 6e7;  // of all cells, a batch
constexpr double least_left = 1e-4;
constexpr int most_bends = 4096;
/// Of a body's size: how far about a place light is taken for the place's own.
constexpr double gathered_within = 0.05;

}  // namespace

UnscatteredLight::UnscatteredLight(const MeshHeap& heap, const std::vector<Channel>& channels,
                                   const std::vector<scene::Light>& lights, std::uint64_t rays, std::uint64_t seed,
                                   unsigned threads)
    : heap_(heap), channels_(channels), lights_(lights) {
  choose_cells();
  std::vector<Batch> parts(batches);
  parallel(batches, threads, [&](std::size_t i) {
    Rng rng(seed ^ 0x5eedULL, i);
    parts[i].tracks.resize(fluence_.size());
    if (fluence_.empty()) return;  // no media
    for (const scene::Light& light : lights_) trace(light, rays / batches, rays / batches * batches, rng, parts[i]);
  });
  for (std::size_t i = 0; i < fluence_.size(); ++i)
    for (const Batch& part : parts) fluence_[i] += part.tracks[i];
  measure(fluence_);
  std::vector<Photon> photons;
  for (const Batch& part : parts) photons.insert(photons.end(), part.photons.begin(), part.photons.end());
  sort(std::move(photons));
}

/// As fine as light changes in a body, or as memory allows.
void UnscatteredLight::choose_cells() {
  std::vector<double> wanted(heap_.bodies().size(), fewest_across);
  double numbers = 0;
  const auto cells_across = [&](std::uint32_t number) {
    double thickest = 0;
    for (const Channel& channel : channels_) thickest = std::max(thickest, channel.matter[number].sigma_t);
    const glm::dvec3 extent = heap_.body(number).upper() - heap_.body(number).lower();
    const double scale = std::cbrt(std::abs(glm::determinant(glm::dmat3(heap_.to_world(number)))));
    return std::clamp(thickest * scale * std::max({extent.x, extent.y, extent.z}) / widest_cell, fewest_across,
                      most_across);
  };
  for (std::uint32_t i = 0; i < heap_.size(); ++i) {
    double& across = wanted[heap_.body_index(i)];
    if (heap_.is_solid(i)) across = std::max(across, cells_across(i));
  }
  for (std::uint32_t i = 0; i < heap_.size(); ++i)
    if (heap_.is_solid(i)) numbers += std::pow(wanted[heap_.body_index(i)], 3) * static_cast<double>(channels_.size());
  const double coarser = std::min(1.0, std::cbrt(most_numbers / std::max(numbers, 1.0)));
  for (std::size_t i = 0; i < heap_.bodies().size(); ++i)
    cells_.emplace_back(heap_.bodies()[i], std::max(wanted[i] * coarser, 4.0));
  std::size_t end = 0;
  for (std::uint32_t i = 0; i < heap_.size(); ++i) {
    offsets_.push_back(end);
    if (heap_.is_solid(i)) end += cells_[heap_.body_index(i)].count() * channels_.size();
  }
  fluence_.resize(end);
}

void UnscatteredLight::measure(std::vector<float>& tracks) const {
  std::vector<std::vector<double>> volumes;
  for (std::size_t i = 0; i < cells_.size(); ++i) volumes.push_back(cells_[i].volumes(heap_.bodies()[i]));
  for (std::uint32_t i = 0; i < heap_.size(); ++i) {
    if (!heap_.is_solid(i)) continue;
    const std::vector<double>& inside = volumes[heap_.body_index(i)];
    const double scale = std::abs(glm::determinant(glm::dmat3(heap_.to_world(i))));
    for (std::size_t cell = 0; cell < inside.size(); ++cell)
      for (std::size_t channel = 0; channel < channels_.size(); ++channel) {
        float& of = tracks[offsets_[i] + cell * channels_.size() + channel];
        of = inside[cell] > 0 ? static_cast<float>(of / (scale * inside[cell])) : 0.0F;
      }
  }
}

void UnscatteredLight::trace(const scene::Light& light, std::uint64_t rays, std::uint64_t all, Rng& rng,
                             Batch& batch) const {
  const Box media = heap_.bounds(true), scene = heap_.bounds(false);
  const Target target{0.5 * (media.lower + media.upper), 0.5 * glm::distance(media.lower, media.upper)};
  const double away = glm::distance(scene.lower, scene.upper) + target.radius;
  const std::size_t count = channels_.size();
  for (std::uint64_t ray = 0; ray < rays; ++ray) {
    const SentRay leaving = send_ray(light, target, away, rng);
    glm::dvec3 place = leaving.place, direction = leaving.direction;
    std::array<double, 3> power{};
    for (std::size_t i = 0; i < count; ++i) power[i] = leaving.power[channels_[i].number] / static_cast<double>(all);
    const std::array<double, 3> sent = power;
    bool bent = false;
    int bends = 0;
    const auto follow_inside = [&](std::uint32_t number, double length) {
      const glm::dvec3 from(heap_.to_body(number) * glm::dvec4(place, 1)),
          way(heap_.to_body(number) * glm::dvec4(direction, 0));
      const double scale = glm::length(way);  // body's lengths for one of the world
      cells_[heap_.body_index(number)].follow(
          from, way / scale, scale * length, [&](std::size_t cell, double begin, double end) {
            for (std::size_t i = 0; i < count; ++i) {
              const double sigma = channels_[i].matter[number].sigma_t;
              const double mean =
                  sigma > 0 ? std::exp(-sigma * begin / scale) * -std::expm1(sigma * (begin - end) / scale) / sigma
                            : (end - begin) / scale;
              batch.tracks[offsets_[number] + cell * count + i] += static_cast<float>(power[i] * mean);
            }
          });
      bool any = false;
      for (std::size_t i = 0; i < count; ++i) {
        power[i] *= std::exp(-channels_[i].matter[number].sigma_t * length);
        any = any || power[i] > least_left * sent[i];
      }
      return any;
    };
    bool goes_on = true;
    while (goes_on && bends < most_bends) {
      const std::optional<MeshHeap::Hit> hit = heap_.first(place, direction);
      if (!hit) break;
      place += hit->distance * direction;
      if (!heap_.is_solid(hit->number)) {
        if (!bent) break;
        Photon photon{glm::vec3(place), glm::vec3(direction), hit->number, {}};
        for (std::size_t i = 0; i < count; ++i) photon.power[i] = static_cast<float>(power[i]);
        batch.photons.push_back(photon);
        break;
      }
      const RoughInterface& surface = channels_.front().matter[hit->number].surface;
      bent = bent || !surface.matched();
      direction = glm::normalize(surface.beyond(direction, hit->normal, rng));
      ++bends;
      bool in = glm::dot(direction, hit->normal) < 0;
      while (in && goes_on && bends < most_bends) {
        const std::optional<MeshHeap::Hit> own = heap_.inside(hit->number, place, direction);
        if (!own) {
          goes_on = false;
          break;
        }
        goes_on = follow_inside(hit->number, own->distance);
        place += own->distance * direction;
        direction = glm::normalize(surface.beyond(direction, own->normal, rng));
        ++bends;
        in = glm::dot(direction, own->normal) < 0;
      }
    }
  }
}

void UnscatteredLight::sort(std::vector<Photon> photons) {
  double sizes = 0, count = 0;
  for (std::uint32_t i = 0; i < heap_.size(); ++i)
    if (heap_.is_solid(i)) sizes += glm::distance(heap_.box(i).lower, heap_.box(i).upper), ++count;
  radius_ = count > 0 ? gathered_within * sizes / count : 1;
  const auto of = [&](const Photon& photon) {
    return bucket(glm::ivec3(glm::floor(glm::dvec3(photon.place) / radius_)));
  };
  photons_ = std::move(photons);
  std::stable_sort(photons_.begin(), photons_.end(), [&](const Photon& a, const Photon& b) { return of(a) < of(b); });
  for (std::size_t i = 0; i < photons_.size();) {
    const std::int64_t key = of(photons_[i]);
    std::size_t end = i;
    while (end < photons_.size() && of(photons_[end]) == key) ++end;
    buckets_[key] = {i, end};
    i = end;
  }
}

std::int64_t UnscatteredLight::bucket(const glm::ivec3& at) const {
  constexpr std::int64_t wide = 1 << 20;
  return (static_cast<std::int64_t>(at.z) * wide + at.y) * wide + at.x;
}

double UnscatteredLight::fluence(std::uint32_t number, const glm::dvec3& place, std::size_t channel) const {
  const glm::dvec3 local(heap_.to_body(number) * glm::dvec4(place, 1));
  const std::size_t cell = cells_[heap_.body_index(number)].at(local);
  return fluence_[offsets_[number] + cell * channels_.size() + channel];
}

double UnscatteredLight::left_of(const SeenPoint& seen, const glm::dvec3& place, std::size_t channel) const {
  double left = seen.irradiance[channels_[channel].number];
  glm::dvec3 from = place;
  double remaining = seen.distance;
  const auto is_reached = [&](double distance) {
    from += distance * seen.direction;
    remaining -= distance;
    return remaining <= 0.0;
  };
  while (left > 0) {
    const std::optional<MeshHeap::Hit> hit = heap_.first(from, seen.direction);
    if (!hit || is_reached(hit->distance)) return left;
    const Matter& of = channels_[channel].matter[hit->number];
    if (!heap_.is_solid(hit->number) || !of.surface.matched()) return 0;
    const std::optional<MeshHeap::Hit> own = heap_.inside(hit->number, from, seen.direction);
    if (!own) return left;
    left *= std::exp(-of.sigma_t * std::min(own->distance, remaining));
    if (is_reached(own->distance)) return left;
  }
  return left;
}

double UnscatteredLight::irradiance(std::uint32_t number, const glm::dvec3& place, const glm::dvec3& normal,
                                    std::size_t channel, Rng& rng) const {
  double sum = 0;
  const glm::ivec3 middle(glm::floor(place / radius_));
  for (int i = 0; i < 27; ++i) {
    const auto found = buckets_.find(bucket(middle + glm::ivec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1)));
    if (found == buckets_.end()) continue;
    for (std::size_t at = found->second.first; at < found->second.second; ++at) {
      const Photon& photon = photons_[at];
      if (photon.number == number && glm::dot(glm::dvec3(photon.direction), normal) < 0 &&
          glm::distance(glm::dvec3(photon.place), place) < radius_)
        sum += photon.power[channel];
    }
  }
  sum /= std::numbers::pi * radius_ * radius_;
  return sum + straight(place, normal, channel, rng,
                        [&](const glm::dvec3& to_light, double comes) { return comes * glm::dot(normal, to_light); });
}

}  // namespace mesograin::referee

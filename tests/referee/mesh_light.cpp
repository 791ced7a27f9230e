// Rays from the sun leave the lengths of their ways in the cells that they pass.
#include "mesh_light.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

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

}  // namespace

MeshLight::MeshLight(const MeshBody& body, const RoughInterface& interface, const scene::DirectionalLight& sun,
                     bool directions, std::uint64_t seed, unsigned threads)
    : lower_(body.lower()), parts_(batches_) {
  const glm::dvec3 extent = body.upper() - body.lower();
  const double longest = std::max({extent.x, extent.y, extent.z});
  const double wanted =
      std::clamp(longest / widest, 1.0 * fewest, directions ? 1.0 * most_with_directions : 1.0 * most);
  side_ = longest / wanted;
  size_ = glm::ivec3(glm::ceil(extent / side_)) + 1;
  const auto cells =
      static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) * static_cast<std::size_t>(size_.z);
  parallel(batches_, threads, [&](std::size_t i) {
    Rng rng(seed ^ 0x5eedULL, i);
    parts_[i].tracks.resize(cells);
    if (directions) parts_[i].directions.resize(kept_ * cells);
    trace(body, interface, sun, rng, parts_[i]);
  });
  const std::vector<double> inside = volumes(body);
  fluence_.resize(cells);
  for (std::size_t i = 0; i < cells; ++i) {
    double sum = 0;
    for (const Batch& batch : parts_) sum += batch.tracks[i];
    fluence_[i] = inside[i] > 0 ? static_cast<float>(sum / batches_ / inside[i]) : 0;
  }
  if (!directions) parts_.clear();
}

double MeshLight::fluence(const glm::dvec3& place) const { return fluence_[cell(place)]; }

glm::dvec3 MeshLight::direction(const glm::dvec3& place, Rng& rng) const {
  const std::size_t at = cell(place);
  double sum = 0;
  for (const Batch& batch : parts_) sum += batch.tracks[at];
  double choice = rng.uniform() * sum;
  for (const Batch& batch : parts_) {
    choice -= batch.tracks[at];
    if (choice < 0) return batch.directions[kept_ * at + static_cast<std::size_t>(kept_ * rng.uniform())];
  }
  return {0, 0, 1};
}

std::size_t MeshLight::cell(const glm::dvec3& place) const {
  const glm::ivec3 at = glm::clamp(glm::ivec3(glm::floor((place - lower_) / side_)), glm::ivec3(0), size_ - 1);
  return (static_cast<std::size_t>(at.z) * static_cast<std::size_t>(size_.y) + static_cast<std::size_t>(at.y)) *
             static_cast<std::size_t>(size_.x) +
         static_cast<std::size_t>(at.x);
}

/// visit(cell, begin, end) of every piece of a way (Amanatides and Woo, "A fast voxel traversal algorithm", 1987).
template <class Visit>
void MeshLight::follow(const glm::dvec3& place, const glm::dvec3& direction, double length, const Visit& visit) const {
  const glm::dvec3 from = (place - lower_) / side_;
  glm::ivec3 at = glm::clamp(glm::ivec3(glm::floor(from)), glm::ivec3(0), size_ - 1);
  glm::dvec3 next, step;
  for (int axis = 0; axis < 3; ++axis) {
    const double speed = direction[axis] / side_;
    step[axis] = speed == 0 ? std::numeric_limits<double>::infinity() : 1 / std::abs(speed);
    next[axis] = speed == 0 ? std::numeric_limits<double>::infinity()
                            : ((speed > 0 ? at[axis] + 1 : at[axis]) - from[axis]) / speed;
  }
  const std::size_t row = static_cast<std::size_t>(size_.x), plane = row * static_cast<std::size_t>(size_.y);
  double begin = 0;
  while (begin < length) {
    const int axis = next.x <= next.y && next.x <= next.z ? 0 : next.y <= next.z ? 1 : 2;
    const double end = std::min(next[axis], length);
    if (end > begin)
      visit(static_cast<std::size_t>(at.z) * plane + static_cast<std::size_t>(at.y) * row +
                static_cast<std::size_t>(at.x),
            begin, end);
    begin = std::max(begin, end);
    next[axis] += step[axis];
    at[axis] += direction[axis] > 0 ? 1 : -1;
    if (at[axis] < 0 || at[axis] >= size_[axis]) return;
  }
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
        follow(place, direction, hit->distance, [&](std::size_t at, double begin, double end) {
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

// By straight lines along the axes, sixteen through every cell's side.
std::vector<double> MeshLight::volumes(const MeshBody& body) const {
  constexpr int finer = 4;
  std::vector<double> inside(fluence_.empty() ? static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) *
                                                    static_cast<std::size_t>(size_.z)
                                              : fluence_.size());
  const double share = side_ * side_ / (3.0 * finer * finer);
  for (int axis = 0; axis < 3; ++axis) {
    const int other = (axis + 1) % 3, third = (axis + 2) % 3;
    glm::dvec3 direction(0);
    direction[axis] = 1;
    for (int i = 0; i < finer * size_[other]; ++i)
      for (int j = 0; j < finer * size_[third]; ++j) {
        glm::dvec3 place = lower_;
        // Not where meshes like to have their edges.
        place[axis] -= side_;
        place[other] += (i + 0.4871) * side_ / finer;
        place[third] += (j + 0.5133) * side_ / finer;
        while (const std::optional<MeshHit> hit = body.first_hit(place, direction)) {
          if (hit->normal[axis] > 0)
            follow(place, direction, hit->distance,
                   [&](std::size_t at, double begin, double end) { inside[at] += share * (end - begin); });
          place += hit->distance * direction;
        }
      }
  }
  return inside;
}

}  // namespace mesograin::referee

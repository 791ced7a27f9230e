// A lattice in the room, finer than grains are wide: a spot is free if no grain reaches into a ball around it.
#include "pile/pouring.h"

#include <algorithm>
#include <glm/common.hpp>
#include <utility>

#include "base/error.h"
#include "pile/contacts.h"

namespace mesograin::pile {
namespace {

constexpr double apart = 1.02;         // spots, in reaches of the largest grain
constexpr std::size_t spots_each = 8;  // as many as that can be where one grain is

double room_of(const Grain& grain) {
  return grain.size * grain.shape->reach * (is_compact(*grain.shape) ? compact_room : 1.0);
}

}  // namespace

Pouring::Pouring(std::vector<Grain> waiting, const Triangles& surface, std::uint64_t seed)
    : random_(seed), waiting_(std::move(waiting)) {
  for (const Grain& grain : waiting_) {
    reach_ = std::max(reach_, grain.size * grain.shape->reach);
    room_ = std::max(room_, room_of(grain));
  }
  std::shuffle(waiting_.begin(), waiting_.end(), random_);
  const Room room(surface);
  // From wall to wall of a box, and no more spots than grains could need.
  const glm::dvec3 first = surface.lower() + apart * reach_;
  const glm::dvec3 span = glm::max(surface.upper() - surface.lower() - 2.0 * apart * reach_, glm::dvec3(0.0));
  const glm::dvec3 steps = glm::max(glm::floor(span / (apart * reach_)), glm::dvec3(1.0));
  for (int z = 0; z <= steps.z && spots_.size() < spots_each * waiting_.size(); ++z)
    for (int y = 0; y <= steps.y; ++y)
      for (int x = 0; x <= steps.x; ++x) {
        const glm::dvec3 spot = first + span * glm::dvec3(x, y, z) / steps;
        if (room.fits(spot, reach_)) spots_.push_back(spot);
      }
  if (spots_.empty()) throw Error("No grain fits inside the mesh: choose smaller grains, or a larger mesh.");
}

std::size_t Pouring::pour(std::vector<Grain>& grains) {
  if (waiting_.empty()) return 0;
  std::vector<glm::dvec3> middles;
  std::vector<double> reaches;
  for (const Grain& grain : grains) {
    middles.push_back(grain.middle);
    reaches.push_back(room_of(grain));
  }
  middles.insert(middles.end(), spots_.begin(), spots_.end());
  reaches.insert(reaches.end(), spots_.size(), room_);
  const Neighbours neighbours(middles, reaches);
  const std::size_t before = grains.size();
  std::vector<bool> taken(before + spots_.size(), false);
  std::fill_n(taken.begin(), before, true);
  for (std::size_t i = 0; i < spots_.size() && !waiting_.empty(); ++i) {
    bool free = true;
    neighbours.visit(static_cast<std::uint32_t>(before + i), [&](std::uint32_t other) { free &= !taken[other]; });
    if (!free) continue;
    taken[before + i] = true;
    Grain grain = waiting_.back();
    waiting_.pop_back();
    grain.middle = spots_[i];
    grain.turn = drawn_turn(*grain.shape, random_);
    grains.push_back(grain);
  }
  return grains.size() - before;
}

}  // namespace mesograin::pile

// Balls where grains were and are, as rays find them.
#include "heap/moves.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace mesograin::heap {
namespace {

// Of many grains: beyond that nearly every other one has a ray that meets one of them.
constexpr std::size_t most_moved_of = 20;

// A ray that goes through other grains strays by as much of a radius.
constexpr float margin = 1e-3F;

}  // namespace

std::optional<Moves> Moves::between(const Grains& before, const Grains& now) {
  const std::size_t count = now.grains.size();
  if (before.grains.size() != count || before.kinds != now.kinds || before.walls != now.walls ||
      before.panes != now.panes)
    return std::nullopt;
  std::vector<bool> moved(count, false);
  Grains places;
  std::size_t few = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (before.grains[i] == now.grains[i]) continue;
    moved[i] = true;
    if (++few > count / most_moved_of) return std::nullopt;
    for (const Grain& at : {before.grains[i], now.grains[i]}) {
      places.grains.push_back(at);
      places.grains.push_back({at.middle, at.radius * (1.0F + margin), at.kind});
    }
  }
  if (places.grains.empty()) return std::nullopt;
  return Moves(std::move(moved), places);
}

Moves::Moves(std::vector<bool> moved, const Grains& places) : moved_(std::move(moved)), places_(places) {
  glm::vec3 lower(std::numeric_limits<float>::max());
  glm::vec3 upper(-lower);
  for (const Grain& at : places.grains) {
    lower = glm::min(lower, at.middle - at.radius);
    upper = glm::max(upper, at.middle + at.radius);
  }
  middle_ = 0.5F * (lower + upper);
  reach_ = 0.51F * glm::distance(lower, upper);
}

std::optional<float> Moves::distance(const glm::vec3& origin, const glm::vec3& direction) const {
  const glm::vec3 to_middle = middle_ - origin;
  const float along = glm::dot(to_middle, direction);
  if (along < -reach_ || glm::dot(to_middle, to_middle) - along * along > reach_ * reach_) return std::nullopt;
  const std::optional<Meeting> meeting = places_.first(origin, direction);
  if (!meeting) return std::nullopt;
  return glm::dot(meeting->place - origin, direction);
}

}  // namespace mesograin::heap

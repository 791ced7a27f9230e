// Rays from places that are spread evenly over a grain, each of which the world's light comes along or does not.
#include "heap/entered.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "heap/spread.h"

namespace mesograin::heap {
namespace {

/// Light that comes in, if nothing is in its way.
struct Entry {
  Ray ray;  ///< towards where it comes from
  glm::vec3 normal;
  float mu;
};

std::vector<Entry> entries_of(const Space& space, const Grain& grain, int count, transport::Random& random) {
  const Spread spread(random);
  std::vector<Entry> entries;
  entries.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const std::array<float, 5> point = spread.point(i);
    const glm::vec3 normal = transport::isotropic(point[0], point[1]);
    const float mu = std::sqrt(point[2]);
    const glm::vec3 to_light = TurnedFrame(normal, point[4]) * glm::vec3(std::sqrt(1.0F - point[2]), 0.0F, mu);
    entries.push_back({{space.place(grain, normal), to_light, glm::vec3(1.0F)}, normal, mu});
  }
  return entries;
}

template <typename Wanted>
void find(const Space& space, const Rays& rays, const glm::vec3& radiance, PackedField& entered,
          const transport::Effort& effort, const Wanted& wanted) {
  constexpr std::size_t grains_a_piece = 64;
  constexpr std::uint64_t entered_seed = 3;  // more than an effort's
  entered.resize(space.told_entered());
  const std::size_t count = entered.size();
  transport::run_pieces(effort, (count + grains_a_piece - 1) / grains_a_piece, [&](std::size_t piece) {
    for (std::size_t i = piece * grains_a_piece; i < std::min(count, (piece + 1) * grains_a_piece); ++i) {
      const std::uint32_t number = space.seats()->number(i);
      const GrainTable& table = *space.kind(number).from_light;
      if (!table.is_turbid()) continue;
      transport::Random random(effort.seed + entered_seed, number);
      std::vector<Entry> entries = entries_of(space, space.grains()[number], rays.of(i), random);
      if (!wanted(number, entries)) continue;
      const glm::vec3 each = radiance / static_cast<float>(entries.size());
      Coefficients sum;
      for (Entry& entry : entries) {
        const glm::vec3 left = space.passed(entry.ray, std::numeric_limits<float>::infinity());
        if (left == glm::vec3(0.0F)) continue;
        const TurnedFrame frame(entry.normal, -entry.ray.direction);
        table.response(entry.mu).add_to(sum, frame, each * left);
      }
      entered[i] = PackedCoefficients(sum);
    }
  });
}

}  // namespace

void find_entered(const Space& space, const Rays& rays, const glm::vec3& radiance, PackedField& entered,
                  const transport::Effort& effort) {
  find(space, rays, radiance, entered, effort, [](std::uint32_t, const std::vector<Entry>&) { return true; });
}

void renew_entered(const Space& space, const Moves& moves, const Rays& rays, const glm::vec3& radiance,
                   PackedField& entered, const transport::Effort& effort) {
  find(space, rays, radiance, entered, effort, [&](std::uint32_t number, const std::vector<Entry>& entries) {
    return moves.moved(number) || std::any_of(entries.begin(), entries.end(), [&](const Entry& entry) {
             return moves.distance(entry.ray.origin, entry.ray.direction).has_value();
           });
  });
}

}  // namespace mesograin::heap

// Rays go from grain to grain, through those that let them.
#include "heap/heap.h"

#include <algorithm>
#include <bit>
#include <glm/geometric.hpp>

namespace mesograin::heap {
namespace {

// Through more grains nothing is followed.
constexpr int most_crossed = 4096;

float mean(const glm::vec3& colour) { return (colour.r + colour.g + colour.b) / 3.0F; }

}  // namespace

std::vector<Kind> kinds_of(const Grains& grains, int most_walks, const transport::Effort& effort) {
  // What one kind's table is too bright another's is too dark, the more so the more there are.
  constexpr std::size_t few = 8;
  const std::size_t shares = std::bit_floor(std::max(grains.kinds.size() / few, std::size_t{1}));
  const int walks = std::max(most_walks / static_cast<int>(std::min(shares, std::size_t{1024})), GrainTable::outcomes);
  std::vector<Kind> kinds;
  double done = 0.0;
  for (const Optics& optics : grains.kinds) {
    const double next = done + 1.0 / static_cast<double>(grains.kinds.size());
    const transport::Effort part = transport::part_of(effort, done, next);
    kinds.push_back(
        {grain_table(optics, Sense::from_light, part, walks), grain_table(optics, Sense::from_viewer, part, walks)});
    done = next;
  }
  return kinds;
}

void Space::cross(Ray& ray, const Meeting& meeting, float cosine) const {
  const Grain& grain = grains_[meeting.grain];
  ray.origin = place(grain, meeting.normal + 2.0F * cosine * ray.direction);
  ray.crossed = true;
}

std::optional<Meeting> Space::follow(Ray& ray, transport::Random& random) const {
  Meeting meeting{};
  for (int crossed = 0; crossed < most_crossed; ++crossed) {
    if (!neighbourhood_.first(ray.origin, ray.direction, meeting)) return std::nullopt;
    const float cosine = std::clamp(-glm::dot(meeting.normal, ray.direction), 0.0F, 1.0F);
    const glm::vec3 crossing = kind(meeting.grain).from_light->crossing(cosine);
    const glm::vec3 passed = ray.weight * crossing;
    const float all = mean(ray.weight);
    const float share = all > 0.0F ? mean(passed) / all : 0.0F;
    if (!(share > 0.0F)) return meeting;
    if (share < 1.0F && random.uniform() >= share) {
      ray.weight = (ray.weight - passed) / (1.0F - share);
      return meeting;
    }
    ray.weight = passed / share;
    cross(ray, meeting, cosine);
  }
  ray.weight = glm::vec3(0.0F);
  return std::nullopt;
}

glm::vec3 Space::passed(Ray& ray, float reach) const {
  constexpr float nothing = 1e-5F;
  const glm::vec3 start = ray.origin;
  glm::vec3 left(1.0F);
  Meeting meeting{};
  for (int crossed = 0; crossed < most_crossed; ++crossed) {
    if (!neighbourhood_.first(ray.origin, ray.direction, meeting)) return left;
    const Grain& grain = grains_[meeting.grain];
    if (glm::distance(start, grain.middle + grain.radius * meeting.normal) > reach) return left;
    const float cosine = std::clamp(-glm::dot(meeting.normal, ray.direction), 0.0F, 1.0F);
    left *= kind(meeting.grain).from_light->crossing(cosine);
    cross(ray, meeting, cosine);
    if (std::max({left.r, left.g, left.b}) < nothing) break;
  }
  return glm::vec3(0.0F);
}

}  // namespace mesograin::heap

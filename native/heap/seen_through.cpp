// What shows through a grain where none answers another: what lights do in the first grain behind it that a ray meets.
#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "heap/gather.h"

namespace mesograin::heap {

bool Gather::is_lit(std::uint32_t grain) const {
  return heap_.grains.kinds[space_.grains()[grain].kind].surface == Surface::lambert || sees_all(grain);
}

glm::vec3 Gather::lit_behind(std::uint32_t grain, const glm::vec3& normal, const glm::vec3& towards,
                             transport::Random& random) const {
  Ray ray = ray_through(grain, normal, towards);
  if (std::max({ray.weight.r, ray.weight.g, ray.weight.b}) < nothing) return glm::vec3(0.0F);
  const std::optional<Source> source = space_.follow(ray, random);
  if (!source || source->number >= space_.grains().size()) return glm::vec3(0.0F);
  const Grain& behind = space_.grains()[source->number];
  if (!is_lit(source->number)) return glm::vec3(0.0F);
  const glm::vec3& facing = source->facing;
  const float cosine = std::clamp(-glm::dot(facing, ray.direction), 0.0F, 1.0F);
  const glm::vec3 met = 1.0F - space_.kind(source->number).from_light->crossing(cosine);
  // What does not go straight through it is in the ray's weight as in the walk's.
  const glm::vec3 weight = ray.weight / glm::max(met, 1e-6F);
  return weight * look_at_all(source->number, behind.radius * facing, facing, -ray.direction, {1}, random).scattered;
}

glm::vec3 Gather::lit_behind(const SeenFacet& seen, const Facets& facets, transport::Random& random) const {
  const glm::vec3 direction = -seen.towards;
  const std::optional<End> across = end_across(seen.grain, seen.place, direction, facets);
  if (across && across->wall) return glm::vec3(0.0F);
  glm::vec3 weight = left_across_seen(seen.grain, across);
  glm::vec3 place = seen.place + (across ? across->distance : 0.0F) * direction;
  std::uint32_t grain = seen.grain;
  for (int crossed = 0; crossed < most_crossed; ++crossed) {
    if (std::max({weight.r, weight.g, weight.b}) < nothing) break;
    const std::optional<Meeting> meeting = beyond_panes(grain, place, direction, true, facets, weight);
    if (!meeting || meeting->wall) break;
    grain = meeting->number;
    const std::optional<End> end = end_across(grain, meeting->place, direction, facets);
    const glm::vec3 left = weight * left_across_other(grain, end);
    const float share = (left.r + left.g + left.b) / (weight.r + weight.g + weight.b);
    if (random.uniform() >= share) {
      const SeenFacet behind{grain, meeting->place, meeting->normal, -direction};
      const std::optional<All> all = is_lit(grain) ? look_at_all(behind, facets, {1}, random) : std::nullopt;
      return all ? weight / (1.0F - share) * all->scattered : glm::vec3(0.0F);
    }
    if (end && end->wall) break;
    weight = left / share;
    place = meeting->place + (end ? end->distance : 0.0F) * direction;
  }
  return glm::vec3(0.0F);
}

}  // namespace mesograin::heap

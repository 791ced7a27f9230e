// What shows through a grain where none answers another: what lights do in the first grain behind it that a ray meets.
#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "heap/gather.h"

namespace mesograin::heap {

glm::vec3 Gather::lit_behind(std::uint32_t grain, const glm::vec3& normal, const glm::vec3& towards,
                             transport::Random& random) const {
  Ray ray = ray_through(grain, normal, towards);
  constexpr float nothing = 1e-3F;
  if (std::max({ray.weight.r, ray.weight.g, ray.weight.b}) < nothing) return glm::vec3(0.0F);
  const std::optional<Source> source = space_.follow(ray, random);
  if (!source || source->number >= space_.grains().size()) return glm::vec3(0.0F);
  const Grain& behind = space_.grains()[source->number];
  const Surface surface = heap_.grains.kinds[behind.kind].surface;
  if (surface != Surface::lambert && !sees_all(source->number)) return glm::vec3(0.0F);
  const glm::vec3 facing = glm::normalize(ray.origin - behind.middle);
  const float cosine = std::clamp(-glm::dot(facing, ray.direction), 0.0F, 1.0F);
  const glm::vec3 met = 1.0F - space_.kind(source->number).from_light->crossing(cosine);
  // What does not go straight through it is in the ray's weight as in the walk's.
  const glm::vec3 weight = ray.weight / glm::max(met, 1e-6F);
  return weight * look_at_all(source->number, behind.radius * facing, facing, -ray.direction, 1, random).scattered;
}

}  // namespace mesograin::heap

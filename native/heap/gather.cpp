// Rays go where the table sends what comes from the viewer, to what sends light from there.
#include "heap/gather.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "heap/spread.h"

namespace mesograin::heap {

Gather::Gather(Heap heap, std::shared_ptr<const HeapLight> light)
    : heap_(std::move(heap)), light_(std::move(light)), space_(heap_.grains, light_->kinds) {}

glm::vec3 Gather::look(std::uint32_t grain, const glm::vec3& normal, const glm::vec3& towards, int rays,
                       transport::Random& random) const {
  const Kind& kind = space_.kind(grain);
  const float mu = std::clamp(glm::dot(normal, towards), 0.0F, 1.0F);
  const TurnedFrame frame(normal, -towards);
  const glm::vec3 world(heap_.world.image ? glm::dvec3(0.0) : heap_.world.radiance);
  glm::vec3 sum(0.0F);
  for (int i = 0; i < rays; ++i) {
    const Outcome outcome = kind.from_viewer->draw(mu, random.uniform());
    Ray ray{space_.place(space_.grains()[grain], frame * outcome.normal), frame * outcome.direction, outcome.weight};
    if (const std::optional<Source> source = space_.follow(ray, random))
      sum += ray.weight / source->met * light_->sent[source->number].at(source->normal);
    else if (ray.crossed)
      sum += ray.weight * world;
  }
  sum /= static_cast<float>(rays);
  sum += kind.from_light->lobe_at(mu) * light_->crossed[grain].at(normal);
  sum += seen_through(grain, normal, towards, random);
  return glm::max(sum, 0.0F);
}

glm::vec3 Gather::seen_through(std::uint32_t grain, const glm::vec3& normal, const glm::vec3& towards,
                               transport::Random& random) const {
  const float mu = std::clamp(glm::dot(normal, towards), 0.0F, 1.0F);
  Ray ray{space_.place(space_.grains()[grain], normal - 2.0F * mu * towards), -towards,
          space_.kind(grain).from_viewer->crossing(mu)};
  return space_.seen_along(ray, light_->sent, random);
}

}  // namespace mesograin::heap

// A light at a time.
#include "heap/draws.h"

#include <memory>

#include "lights/world_light.h"

namespace mesograin::heap {

std::vector<Draw> draws_of(const Heap& heap) {
  std::vector<Draw> draws;
  for (const scene::Light& light : heap.lights)
    draws.emplace_back(
        [&light](const glm::dvec3& place, const glm::dvec2& random) { return lights::sample(light, place, random); });
  if (heap.world.image && heap.world.shines())
    draws.emplace_back([world = std::make_shared<const lights::WorldLight>(heap.world)](
                           const glm::dvec3& /*place*/, const glm::dvec2& random) { return world->draw(random); });
  return draws;
}

}  // namespace mesograin::heap

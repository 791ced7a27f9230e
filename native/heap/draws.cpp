// A light at a time.
#include "heap/draws.h"

namespace mesograin::heap {

std::shared_ptr<const lights::WorldLight> image_of(const Heap& heap) {
  const bool shines = heap.world.image && heap.world.shines();
  return shines ? std::make_shared<const lights::WorldLight>(heap.world) : nullptr;
}

std::vector<Draw> draws_of(const Heap& heap, const std::shared_ptr<const lights::WorldLight>& image) {
  std::vector<Draw> draws;
  for (const scene::Light& light : heap.lights)
    draws.emplace_back(
        [&light](const glm::dvec3& place, const glm::dvec2& random) { return lights::sample(light, place, random); });
  if (image)
    draws.emplace_back([image](const glm::dvec3& /*place*/, const glm::dvec2& random) { return image->draw(random); });
  return draws;
}

}  // namespace mesograin::heap

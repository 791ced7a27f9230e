// Light is proportional to what shines.
#include "heap/scaled_light.h"

#include <glm/vec2.hpp>
#include <numbers>

#include "lights/device_light.h"

namespace mesograin::heap {

glm::dvec3 strength(const Heap& heap) {
  glm::dvec3 middle(0.0);
  for (const Grain& grain : heap.grains.grains)
    middle += glm::dvec3(grain.middle) / static_cast<double>(heap.grains.grains.size());
  glm::dvec3 sum = std::numbers::pi * heap.world.radiance;
  for (const scene::Light& light : heap.lights)
    sum += glm::dvec3(lights::sample(light, heap.anchor + middle, glm::dvec2(0.5)).irradiance);
  return sum;
}

void scale(HeapLight& light, const glm::vec3& by) {
  const auto scale = [&by](Field& field) {
    for (Coefficients& one : field) one.scale(by);
  };
  for (Field* field : {&light.answer, &light.crossed, &light.behind, &light.scattered, &light.scattered_answer})
    scale(*field);
  for (PackedCoefficients& one : light.entered) heap::scale(one, by);
  Field sent = light.sent;
  scale(sent);
  light.sent = SharedField(std::move(sent));
}

}  // namespace mesograin::heap

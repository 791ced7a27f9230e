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
  for (Field HeapLight::*const field : {&HeapLight::answer, &HeapLight::crossed, &HeapLight::behind, &HeapLight::sent,
                                        &HeapLight::scattered, &HeapLight::scattered_answer})
    for (Coefficients& one : light.*field) one = one * by;
}

}  // namespace mesograin::heap

// Directions of a heap's lights, drawn at random.
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "heap/heap.h"
#include "lights/device_light.h"

namespace mesograin::heap {

/// A direction of light at a place of the world.
using Draw = std::function<lights::LightDraw(const glm::dvec3& place, const glm::dvec2& random)>;

/// Of each light, and of the world if that is an image. For as long as `heap` is there.
std::vector<Draw> draws_of(const Heap& heap);

}  // namespace mesograin::heap

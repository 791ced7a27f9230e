// Directions of a heap's lights, drawn at random.
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "heap/heap.h"
#include "lights/device_light.h"
#include "lights/world_light.h"

namespace mesograin::heap {

/// Within so many of a grain's radii a lamp is another for each place of the grain.
inline constexpr float near_radii = 40.0F;

/// A direction of light at a place of the world.
using Draw = std::function<lights::LightDraw(const glm::dvec3& place, const glm::dvec2& random)>;

/// The world, if that is an image; or null.
std::shared_ptr<const lights::WorldLight> image_of(const Heap& heap);

/// Of each light, and of `image` unless that is null. For as long as `heap` is there.
std::vector<Draw> draws_of(const Heap& heap, const std::shared_ptr<const lights::WorldLight>& image);

}  // namespace mesograin::heap

// A heap's light as it would be if lights had grown stronger: what is shown until it is known what those do.
#pragma once

#include <glm/vec3.hpp>

#include "heap/exchange.h"
#include "heap/heap.h"

namespace mesograin::heap {

/// What all lights and the world send to the middle of the heap together: irradiance of surfaces that face them. Of an
/// image of the world, as if it was white.
glm::dvec3 strength(const Heap& heap);

/// All that is sent out, by as much in each channel.
void scale(HeapLight& light, const glm::vec3& by);

}  // namespace mesograin::heap

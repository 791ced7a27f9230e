// A heap's light where its grains and walls have gone to since: what is shown until that of their new places is known.
#pragma once

#include <optional>

#include "heap/exchange.h"
#include "heap/grains.h"

namespace mesograin::heap {

/// Each grain sends out what it did, and a wall at each of its places, too; what has no place before has the mean of
/// its wall's. Nothing where they are not the same grains and walls.
std::optional<HeapLight> moved_light(const HeapLight& light, const Grains& before, const Grains& now);

}  // namespace mesograin::heap

// Octahedral maps of functions of the direction, as the device has them.
#pragma once

#include <vector>

#include "transport/octahedron.h"

namespace mesograin::models {

/// Texels along a side of a map in its frame: those that lie across its edges are beside it, so that it is smooth
/// there.
constexpr int framed(int side) { return side + 2; }

/// `lobe` is at all texels of the octahedral map; the result is a framed map with `side` of them along a side, no more
/// than that has: linear between fewer it is as near to it as can be.
std::vector<float> framed_map(const std::vector<float>& lobe, int side = transport::octahedron_side);

}  // namespace mesograin::models

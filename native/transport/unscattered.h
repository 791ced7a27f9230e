// Light inside a body that nothing has scattered yet: refracted as it entered, reflected inside.
#pragma once

#include <vector>

#include "transport/body.h"
#include "transport/effort.h"
#include "transport/grid.h"

namespace mesograin::transport {

/// Mean radiance over all directions at every used node, per irradiance of parallel light on a plane that faces it:
/// [texel of the octahedral map that the light comes from][node * extinctions + extinction]. `extinctions` are sigma_t
/// per unit of the body; `across` rays squared for each direction.
std::vector<std::vector<float>> unscattered_light(const Body& body, const Grid& grid, double eta,
                                                  const std::vector<double>& extinctions, int across,
                                                  const Effort& effort);

}  // namespace mesograin::transport

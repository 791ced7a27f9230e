// Light inside a body that nothing has scattered yet: refracted as it entered, reflected inside.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "transport/body.h"
#include "transport/effort.h"
#include "transport/grid.h"
#include "transport/interface.h"
#include "transport/lamp.h"

namespace mesograin::transport {

/// Mean radiance over all directions at every used node, per irradiance of parallel light on a plane that faces it:
/// keep(texel of the octahedral map that the light comes from, [node * extinctions + extinction]), from several
/// threads.
using KeepLight = std::function<void(std::size_t, const std::vector<float>&)>;

/// `extinctions` are sigma_t per unit of the body; the map has `side` texels along a side, and `across` rays squared
/// for each.
void unscattered_light(const Body& body, const Grid& grid, const Interface& interface,
                       const std::vector<double>& extinctions, int side, int across, const KeepLight& keep,
                       const Effort& effort);

/// The same of a lamp, per its strength: [node * extinctions + extinction], by so many `rays`.
std::vector<float> unscattered_light(const Body& body, const Grid& grid, const Interface& interface,
                                     const std::vector<double>& extinctions, int rays, const Lamp& lamp,
                                     const Effort& effort);

}  // namespace mesograin::transport

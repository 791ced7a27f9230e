// Light of a sun that was scattered exactly once, in a body that light goes straight through. It has shadows' edges and
// falls off within a mean free path, which nodes are apart: told of light at nodes it would be wrong.
#pragma once

#include <vector>

#include "transport/body.h"
#include "transport/effort.h"
#include "transport/grid.h"
#include "transport/lamp.h"
#include "transport/multiple.h"

namespace mesograin::transport {

/// Mean radiance at every node of light that was scattered once, per albedo and the lamp's strength, a column for each
/// of `extinctions`. The lamp is far.
Lights scattered_once(const Body& body, const Grid& grid, const std::vector<double>& extinctions, const Lamp& lamp,
                      const Effort& effort);

}  // namespace mesograin::transport

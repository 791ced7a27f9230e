// Whether a mesh can shade itself.
#pragma once

#include "scene/mesh.h"

namespace mesograin::scene {

/// True if the surface is closed and bends outwards at every edge, or is flat: then no part of it can stand between
/// another part and a light that this part faces. Positions that coincide count as one.
bool is_convex(const Mesh& mesh);

}  // namespace mesograin::scene

// The unit sphere as a mesh: fine enough that its polygons cost nothing that a comparison could see.
#pragma once

#include "scene/mesh.h"

namespace mesograin::scene {

/// Radius 1 around the origin on average over each quad, poles on z, exact normals; u runs with the longitude from +x
/// over +y, v from the south pole to the north. 256 x 128 quads deviate from the sphere by 8e-5 of the radius. Needs 3
/// segments and 2 rings.
Mesh unit_sphere(int segments = 256, int rings = 128);

}  // namespace mesograin::scene

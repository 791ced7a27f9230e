// What a sphere's kernel makes of a surface that goes on beyond the sphere.
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "physics/body_medium.h"
#include "physics/kernel_tables.h"

namespace mesograin::physics {

/// How much of what the kernel of the unit sphere gathers from beyond that sphere's surface counts, by channel, 0 to 1.
/// Light that entered there has lost more on the way than the kernel knows: on the plane, the surface that goes on
/// farthest, all of it together must make the half-space's exitance.
glm::dvec3 share_beyond_sphere(const KernelTables& tables, const std::array<BodyMedium, 3>& media,
                               const BodySurface& surface);

}  // namespace mesograin::physics

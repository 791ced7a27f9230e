// What a sphere's kernel makes of a surface that goes on beyond the sphere.
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "physics/body/body_medium.h"
#include "physics/kernels/kernel_tables.h"

namespace mesograin::physics {

/// How much of what the kernel of the unit sphere gathers from beyond a sphere's surface counts, by channel, 0 to 1.
/// Light that entered there has left more on the way than the kernel, whose sphere is all medium, knows: on an endless
/// cylinder of the same mean chord, a body that goes on beyond the sphere that is as thick, all of it together must
/// make the cylinder's own exitance.
glm::dvec3 share_beyond_sphere(const KernelTables& tables, const std::array<BodyMedium, 3>& media,
                               const BodySurface& surface);

}  // namespace mesograin::physics

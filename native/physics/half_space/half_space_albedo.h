// How much light a half-space of a material sends back: one number for each channel, without drawing anything.
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "scene/material.h"

namespace mesograin::physics {

/// The fraction of a beam at `cosine` to the normal that comes back from the medium, all orders of scattering, exact;
/// what the interface itself reflects is not in it. Without a cosine: of light that arrives evenly from everywhere.
/// Throws Error if the material or the cosine (in (0, 1]) is not valid.
glm::dvec3 half_space_albedo(const scene::Material& material, std::optional<double> cosine);

}  // namespace mesograin::physics

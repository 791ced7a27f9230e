// The normals that a rough surface shows to a direction, for quadrature.
#pragma once

#include <glm/vec3.hpp>

namespace mesograin::physics {

/// The visible GGX normal for a point of the unit disk (Heitz 2018, "Sampling the GGX Distribution of Visible Normals",
/// listing 1): points spread evenly over the disk give normals spread like those that `view` sees. `view` is (sine, 0,
/// cosine); azimuths a and pi - a mirror each other in the plane of incidence.
glm::dvec3 visible_normal(const glm::dvec3& view, double alpha, double radius, double azimuth);

}  // namespace mesograin::physics

// What a half-space sends out under a directional light, in the approximation that solves the sphere: what remains of a
// sphere that grows.
#pragma once

#include <algorithm>
#include <vector>

#include "physics/body/body_medium.h"

namespace mesograin::physics {

/// Single scattering's quadrature resolves no narrower peak than this mean cosine's.
inline double tabulated_g(double g) { return std::clamp(g, -0.95, 0.95); }

/// The limit of sphere_multiple_exitance for a large sphere, 0 where the cosine is not positive.
std::vector<double> half_space_multiple_exitance(const BodyMedium& medium, const BodySurface& surface,
                                                 const std::vector<double>& cosines);

/// The same limit of SphereSingleScattering.
std::vector<double> half_space_single_exitance(const BodyMedium& medium, double eta,
                                               const std::vector<double>& cosines);

}  // namespace mesograin::physics

// Directions in which light leaves a point of a sphere, for integrals over them.
#pragma once

#include <vector>

#include "physics/physics.h"

namespace mesograin::physics {

struct ExitDirection {
  real3 inwards;  ///< against the light, inside; the sphere is lit from +z, the point lies in the plane y = 0
  double mu;      ///< cosine inside
  double weight;  ///< transmittance times the cosine, integrated over solid angle inside, over 4 pi
};

/// Where normal and light make this cosine. `g` 0: evenly about the normal; else crowded as a phase function of this
/// mean cosine sends light that comes down the z axis.
std::vector<ExitDirection> exit_directions(double eta, double cosine, double g);

}  // namespace mesograin::physics

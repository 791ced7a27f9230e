// What an endless cylinder of unit radius sends out where it faces a directional light: the body that goes on farthest
// beyond the sphere of its thickness, in one direction.
#pragma once

#include "physics/body/body_medium.h"

namespace mesograin::physics {

/// Exitance per irradiance on the line of the surface that faces the light, which falls at right angles to the axis.
/// The same theory as sphere_multiple_exitance, for the same orders.
double cylinder_multiple_exitance(const BodyMedium& medium, const BodySurface& surface);

}  // namespace mesograin::physics

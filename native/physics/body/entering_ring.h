// What a directional light sends into a spherical grain, on rings about a point of it.
#pragma once

#include <vector>

#include "physics/body/body_medium.h"

namespace mesograin::physics {

/// Irradiance that enters the unit sphere, per irradiance on a plane that faces the light, integrated over a ring's
/// azimuth. `cosine` between light and the point's normal, `ring_cosine` between the point's normal and the ring's.
double entering_ring(const BodySurface& surface, double cosine, double ring_cosine);

/// Light that crosses the unit sphere unscattered where surfaces are Lambert's on both sides: what enters at a distance
/// d leaves here as exp(-sigma_t d) cos cos / (pi d^2), and on a sphere both cosines are d / 2. It is light of the
/// walks of Cycles' Subsurface Scattering node like any other.
class SphereUnscattered {
 public:
  SphereUnscattered(const BodySurface& surface, const std::vector<double>& cosines);

  /// Exitance per irradiance at each of the cosines, for a sphere of this many mean free paths' radius.
  std::vector<double> exitance(double optical_radius) const;

 private:
  std::vector<double> distances_;
  std::vector<std::vector<double>> entering_;  // for each cosine, at each distance
};

}  // namespace mesograin::physics

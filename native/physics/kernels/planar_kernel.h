// The kernels of a half-space that diffuses light, as published.
#pragma once

#include <vector>

#include "physics/body/body_medium.h"
#include "physics/kernels/surface_kernel.h"

namespace mesograin::physics {

/// The half-space profiles of the literature: functions of the distance alone, light enters straight down.
enum class PlanarProfile {
  dipole,  ///< Jensen et al. 2001 eq. 4 (with their erratum corrected: 1/sigma_t' in front of neither term): all orders
  better_dipole,  ///< d'Eon 2012: orders from two up
  photon_beam,    ///< Habel et al. 2013 section 5 as pbrt-v4 tabulates it, 100 depths: orders from two up
};

class PlanarKernel final : public SurfaceKernel {
 public:
  /// `total` rescales the profile to this integral over the plane, if it is positive.
  PlanarKernel(PlanarProfile profile, const BodyMedium& medium, const BodySurface& surface, double total = 0.0);
  std::vector<double> evaluate(const std::vector<double>& distances, double mu) const override;

  /// The integral over the plane, before rescaling, in closed form where there is one.
  double total() const;

 private:
  double radiant_exitance(double distance) const;

  PlanarProfile profile_;
  BodyMedium medium_;
  BodySurface surface_;
  double scale_ = 1.0;
};

}  // namespace mesograin::physics

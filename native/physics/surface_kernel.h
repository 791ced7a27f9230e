// How much light leaves a surface point per flux that entered another, over their distance: the profiles that model 3
// integrates.
#pragma once

#include <vector>

#include "physics/body_medium.h"

namespace mesograin::physics {

/// A function of the distance along the chord, exitance per flux that enters, per square grain radius.
class SurfaceKernel {
 public:
  virtual ~SurfaceKernel() = default;

  /// At each of `distances` (in grain radii), for light that enters at cosine `mu` inside.
  virtual std::vector<double> evaluate(const std::vector<double>& distances, double mu) const = 0;
};

/// Diffusion in the unit sphere, fed by beams that enter at `mu`; orders from two up (or from one if light enters by a
/// cosine lobe, whose average it then is, whatever `mu`). The beam's points lie below its mean point's place on the
/// surface, which the caller shifts to. A grain that is longer than the sphere of its mean chord has distances beyond
/// 2: there the kernel falls on like a point source's light.
class SphereKernel final : public SurfaceKernel {
 public:
  SphereKernel(const BodyMedium& medium, const BodySurface& surface);
  std::vector<double> evaluate(const std::vector<double>& distances, double mu) const override;

 private:
  std::vector<double> evaluate_within(const std::vector<double>& distances, double mu) const;

  BodyMedium medium_;
  BodySurface surface_;
};

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

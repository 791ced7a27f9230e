// What a spherical grain of unit radius sends out under a directional light, over the cosine between normal and light:
// the solution that model 2 compares the half-space with.
#pragma once

#include <vector>

#include "physics/body/body_medium.h"

namespace mesograin::physics {

/// Exitance per irradiance on a plane facing the light, at each of `cosines`; scattering from the second order up, or
/// from the first if the light enters by a cosine lobe. Diffusion from the refracted, attenuated light as its source
/// (photon beam diffusion, Habel et al. 2013, in the sphere instead of the half-space).
std::vector<double> sphere_multiple_exitance(const BodyMedium& medium, const BodySurface& surface,
                                             const std::vector<double>& cosines);

/// Light scattered once, in the sense of marched_in_half_space; exact but for internal reflection. Gathered along rays
/// that leave, whose geometry is the same for every medium of one index and mean cosine.
class SphereSingleScattering {
 public:
  SphereSingleScattering(double eta, double g, const std::vector<double>& cosines);

  /// At each of the cosines, per irradiance; `medium` has the g of the constructor.
  std::vector<double> exitance(const BodyMedium& medium) const;

  /// The same where half_space_single_exitance of a medium as thick or thicker, in proportion, is known.
  std::vector<double> exitance(const BodyMedium& medium, const std::vector<double>& half_space) const;

 private:
  struct Way {
    double in;
    double out;
    double first;  // weight of light that nothing has met before
    double later;  // of light that has met the peak
  };
  double eta_;
  std::vector<double> cosines_;
  std::vector<std::vector<Way>> points_;
};

}  // namespace mesograin::physics

// An index-matched half-space seen along a view ray that a GGX interface refracts, without Fresnel and without masking.
#pragma once

#include <vector>

#include "physics/half_space/half_space_interior.h"

namespace mesograin::physics {

/// What Cycles 4's Subsurface Scattering node solves on the view's side: the normal is sampled from the visible GGX
/// normals (Heitz 2018), the view ray refracted through it, and a ray that would leave upwards is lost.
class RefractedView {
 public:
  /// `roughness` is the GGX alpha; 0 is a smooth interface.
  RefractedView(const Medium& medium, double eta, double roughness);

  /// The fraction of such rays at cosine `mu` (outside) that come out of the medium again.
  double albedo(double mu) const;

 private:
  double albedo_inside(double mu) const;

  double eta_;
  double roughness_;
  std::vector<double> albedo_inside_;  // over sqrt(mu), evenly
};

}  // namespace mesograin::physics

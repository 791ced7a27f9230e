// Where a directional light goes once it has refracted into a sphere: how bright, from which direction, after how long
// a way.
#pragma once

#include <vector>

namespace mesograin::physics {

/// Light that has entered but has met neither matter nor the surface again; a unit sphere lit from +z.
struct RefractedLight {
  double irradiance;  ///< fluence per irradiance on a plane facing the light: Fresnel transmission times focusing
  double path_ratio;  ///< length of its way inside over the depth below the sphere, measured along z
  double sideways;    ///< radial component of its direction, negative towards the axis
};

class SphereRefraction {
 public:
  explicit SphereRefraction(double eta);

  static constexpr int size = 64;

  /// Nodes over q = x/sqrt(1 - z^2) (columns) and (1 + z)/2 (rows), both from 0 to 1; x is the distance from the axis.
  const std::vector<RefractedLight>& nodes() const { return nodes_; }

  /// Between the nodes; the point must lie in the sphere.
  RefractedLight at(double x, double z) const;

 private:
  std::vector<RefractedLight> nodes_;
};

}  // namespace mesograin::physics

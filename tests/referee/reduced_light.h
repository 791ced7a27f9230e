// The unscattered light of a sun inside a dielectric sphere, internal reflections included: which beams cross a point.
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace mesograin::referee {

/// A directional light can't be hit by a path that leaves through a smooth interface, nor seen through one by a
/// straight shadow ray. But in a sphere all unscattered light lies in planes through the axis, so it is traced once,
/// ray by ray, into cells (depth, polar angle, direction in the plane). Shells are thin near the surface, where light
/// fades fastest: never thicker than a twentieth of a mean free path there.
class ReducedLight {
 public:
  /// Light that crosses a cell at nearly one direction, in the meridional plane (rho >= 0, z towards the light).
  struct Beam {
    double toward_rho, toward_z;  ///< unit direction of travel
    double fluence;               ///< mean over the cell, for unit irradiance on a plane that faces the light
  };

  /// `radius` in mean free paths.
  ReducedLight(double radius, double eta);

  /// The beams of the cell that holds the point.
  std::span<const Beam> beams(double rho, double z) const;

 private:
  std::size_t cell(double rho, double z) const;
  double shell_depth(int shell) const;

  double radius_;
  double thinning_ = 0;             ///< depth of shell k of n is R (e^(t k/n) - 1) / (e^t - 1)
  std::vector<std::size_t> first_;  ///< of each cell's beams, and one past the last
  std::vector<Beam> beams_;
};

}  // namespace mesograin::referee

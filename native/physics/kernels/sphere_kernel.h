// The kernel of a sphere that diffuses light.
#pragma once

#include <vector>

#include "physics/body/body_medium.h"
#include "physics/kernels/surface_kernel.h"

namespace mesograin::physics {

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

}  // namespace mesograin::physics

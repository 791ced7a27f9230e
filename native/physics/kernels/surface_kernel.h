// How much light leaves a surface point per flux that entered another, over their distance: the profiles that model 3
// integrates.
#pragma once

#include <vector>

namespace mesograin::physics {

/// A function of the distance along the chord, exitance per flux that enters, per square grain radius.
class SurfaceKernel {
 public:
  virtual ~SurfaceKernel() = default;

  /// At each of `distances` (in grain radii), for light that enters at cosine `mu` inside.
  virtual std::vector<double> evaluate(const std::vector<double>& distances, double mu) const = 0;
};

}  // namespace mesograin::physics

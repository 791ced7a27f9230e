// How light that fades along the surface it leaves by is seen from each side.
#pragma once

#include <vector>

#include "physics/body/body_medium.h"

namespace mesograin::physics {

/// Fluence that grows as exp(flow t) along the surface and decays as exp(-decay s) far inside goes into the depth as
/// cosh(q z) + sinh(q z)/(q b), q^2 = decay^2 - flow^2 and b the boundary length; what is seen in a direction is its
/// integral along the ray, which fades as exp(-s) (the formal solution; without a boundary it is the asymptotic one of
/// Case and Zweifel 1967, section 4.3):
///   radiance ~ (p + slope mu')/(p^2 - q^2 mu'^2), p = 1 - flow w,
/// w: how far the ray inwards runs along the flow. Everything per reduced mean free path. Without flow and decay it is
/// the ExitLobe.
class FlowingLobe {
 public:
  explicit FlowingLobe(const BodySurface& surface);

  /// The flux of the ExitLobe over that of the radiance above, where both are the same without flow and decay.
  double share(double flow, double decay) const;

 private:
  struct Direction {
    double mu;
    double along;
    double weight;
  };
  double slope_;
  double plain_;
  std::vector<Direction> directions_;
};

/// Light fades faster than this neither far inside nor along a surface: it would no longer be diffused.
inline constexpr double largest_lobe_decay = 0.55;
inline constexpr double largest_flow = 0.7;

}  // namespace mesograin::physics

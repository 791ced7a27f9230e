// Forward-peaked scattering in two parts: a peak that goes straight on, and a broader rest.
#pragma once

namespace mesograin::physics {

/// The share of scattering that counts as none, so that the rest is another Henyey-Greenstein function that keeps the
/// first two moments: g^2, and g/(1+g) is left (Joseph, Wiscombe & Weinman 1976 eq. 5). Backward scattering has no
/// peak.
struct ForwardPeak {
  explicit ForwardPeak(double g);

  double share;
  double rest;  ///< 1 - share, never the difference
  double rest_g;
};

}  // namespace mesograin::physics

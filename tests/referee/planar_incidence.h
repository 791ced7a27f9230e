// How light enters a flat surface: as a beam or diffusely. Photons start inside, so that results are per transmitted
// flux.
#pragma once

#include <algorithm>
#include <cmath>

#include "interface.h"
#include "rng.h"
#include "walk.h"

namespace mesograin::referee {

struct PlanarIncidence {
  double cosine = 1;     ///< of the incident beam, outside; ignored for diffuse light
  bool diffuse = false;  ///< cosine-weighted outside (without interface: Lambertian entry)

  /// A photon just below z = 0, going towards positive z.
  Photon enter(const Interface& interface, Rng& rng) const {
    double outside = cosine;
    if (diffuse) {
      do outside = std::sqrt(rng.uniform_positive());
      while (rng.uniform() < interface.reflectance_from_outside(outside));  // keeps angles in proportion to their flux
    }
    const double sine = std::sqrt((1 - outside) * (1 + outside)) / interface.eta;
    return {{0, 0, 0}, {sine, 0, std::sqrt(std::max(0.0, 1 - sine * sine))}};
  }
};

}  // namespace mesograin::referee

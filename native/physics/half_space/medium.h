// One colour channel of a scattering medium as a half-space sees it: nothing has a length, all that counts is the
// albedo and g.
#pragma once

#include "scene/material.h"

namespace mesograin::physics {

struct Medium {
  double albedo = 0.0;            ///< sigma_s / sigma_t
  double one_minus_albedo = 1.0;  ///< sigma_a / sigma_t, never the difference
  double g = 0.0;                 ///< mean cosine of the Henyey-Greenstein function

  bool operator==(const Medium&) const = default;
};

/// Beyond this |g| a medium is answered by its similar one: same sigma_a, same sigma_s (1 - g) (van de Hulst 1980,
/// section 14.1.3).
inline constexpr double largest_half_space_g = 0.9;

/// `material`'s medium in one channel, |g| at most largest_half_space_g. A medium without any coefficient sends nothing
/// back.
Medium half_space_medium(const scene::Material& material, int channel);

/// The isotropic medium that is similar to half_space_medium: its albedo is alpha' = sigma_s (1 - g)/(sigma_a + sigma_s
/// (1 - g)).
Medium reduced_medium(const scene::Material& material, int channel);

}  // namespace mesograin::physics

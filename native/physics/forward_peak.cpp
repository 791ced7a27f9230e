// g^2 and what is left of it, written so that neither cancels.
#include "physics/forward_peak.h"

namespace mesograin::physics {

ForwardPeak::ForwardPeak(double g)
    : share(g > 0.0 ? g * g : 0.0), rest(g > 0.0 ? (1.0 - g) * (1.0 + g) : 1.0), rest_g(g > 0.0 ? g / (1.0 + g) : g) {}

}  // namespace mesograin::physics

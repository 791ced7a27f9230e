// The Embree device that all trees share.
#pragma once

#include "embree/rtcore.h"

namespace mesograin::casting {

/// Null if Embree does not start or has no packets of eight on this machine.
RTCDevice embree_device();

}  // namespace mesograin::casting

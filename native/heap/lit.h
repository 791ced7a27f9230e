// What lights make grains and walls send.
#pragma once

#include "heap/coefficients.h"
#include "heap/packed_coefficients.h"

namespace mesograin::heap {

/// What leaves grains and walls because of lights: without and with other grains on the way.
struct Lit {
  Field direct;
  Field crossed;
  Field scattered;      ///< of both, what clear grains have scattered; empty where none is clear
  PackedField entered;  ///< of both, what has entered turbid grains in seats of their own; empty where none is turbid
};

}  // namespace mesograin::heap

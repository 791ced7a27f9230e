// A heap's light as it would be if its grains and walls were made of something else: what is shown until it is known
// what those do.
#pragma once

#include "heap/exchange.h"
#include "heap/grains.h"

namespace mesograin::heap {

/// Makes the light of `before` that of the same grains in the same places, of as many other kinds: each answers as much
/// more as answered_more() finds, and all that they send each other grows as if each met what they send on average.
void change(HeapLight& light, const Grains& before, const Grains& now);

}  // namespace mesograin::heap

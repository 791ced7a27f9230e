// Has the device sum up light between grains, in a context of its own: a solution neither waits for drawing nor holds
// it up.
#pragma once

#include <array>
#include <string_view>

#include "heap/sums.h"

namespace mesograin::render {

/// Who sums over the links between grains.
enum class Summing {
  automatic,  ///< the device where there is a GPU and the links are many, else the processor
  processor,
  device,
};

inline constexpr std::array<std::string_view, 3> summing_names = {"automatic", "processor", "device"};

/// For a solution. Where the device cannot, the processor does.
heap::MakeSums make_sums(Summing by);

}  // namespace mesograin::render

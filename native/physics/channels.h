// Work done once for channels that are the same.
#pragma once

#include <array>

namespace mesograin::physics {

/// Calls `compute` for each of the three, or only once for those that compare equal.
template <typename Medium, typename Compute>
auto for_each_channel(const std::array<Medium, 3>& media, Compute compute) {
  std::array<decltype(compute(media[0])), 3> results;
  for (int channel = 0; channel < 3; ++channel) {
    int same = 0;
    while (!(media[same] == media[channel])) ++same;
    results[channel] = same < channel ? results[same] : compute(media[channel]);
  }
  return results;
}

}  // namespace mesograin::physics

// Numbers that go the same way through a computation, several at a time, as processors are made for.
#pragma once

#include <array>
#include <cstddef>

namespace mesograin::physics {

inline constexpr std::size_t side_by_side = 8;
using SideBySide = std::array<double, side_by_side>;

}  // namespace mesograin::physics

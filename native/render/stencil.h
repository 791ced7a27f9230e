// The stencil tells which pixels a program shades.
#pragma once

#include <cstddef>

namespace mesograin::render {

/// How many things that are shaded apart the stencil's bits tell from each other, beside nothing.
inline constexpr std::size_t most_in_stencil = 0xFF;

/// What marks a thing where `first` is marked 1; 0 if it is not told from nothing.
constexpr int stencil_mark(std::size_t unit, std::size_t first) {
  return unit >= first && unit - first < most_in_stencil ? static_cast<int>(unit - first + 1) : 0;
}

}  // namespace mesograin::render

// Arrays of numbers from NumPy's own file format.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace mesograin::io {

/// Row by row, the last axis fastest.
struct NumberArray {
  std::vector<std::size_t> shape;
  std::vector<double> numbers;
};

/// Reads the bytes of a .npy of float32 or float64, little-endian, in C order. Throws Error if they are damaged or hold
/// something else.
NumberArray parse_npy(std::string_view bytes);

/// The bytes of a .npy of float64.
std::string to_npy(const NumberArray& array);

}  // namespace mesograin::io

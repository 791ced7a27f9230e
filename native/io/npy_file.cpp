// The NPY format, versions 1 to 3: a magic word, a Python dict in text, and the numbers as they are in memory
// (numpy.lib.format).
#include "io/npy_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "base/error.h"
#include "base/readable.h"
#include "io/number.h"

namespace mesograin::io {
namespace {

constexpr std::string_view magic = "\x93NUMPY";
constexpr std::size_t most_numbers = std::size_t{1} << 30;

/// What stands behind a key of the header, up to where `end` begins.
std::string_view value_of(std::string_view header, std::string_view key, std::string_view end) {
  const std::size_t found = header.find(key);
  if (found == std::string_view::npos) throw Error("its header names no {}.", key);
  std::string_view value = header.substr(found + key.size());
  value.remove_prefix(std::min(value.find_first_not_of(": "), value.size()));
  return value.substr(0, value.find(end));
}

std::vector<std::size_t> read_shape(std::string_view header) {
  std::string_view text = value_of(header, "'shape'", ")");
  if (!text.starts_with('(')) throw Error("its header names no shape.");
  text.remove_prefix(1);
  std::vector<std::size_t> shape;
  while (!text.empty()) {
    const std::size_t comma = std::min(text.find(','), text.size());
    std::string_view word = text.substr(0, comma);
    text.remove_prefix(std::min(comma + 1, text.size()));
    word.remove_prefix(std::min(word.find_first_not_of(' '), word.size()));
    if (word.empty()) continue;
    const auto count = parse_integer(word);
    if (!count || *count < 0 || static_cast<unsigned long long>(*count) > most_numbers)
      throw Error("its shape must be of whole numbers up to {}; got '{}'.", most_numbers, base::shortened(word, 40));
    shape.push_back(static_cast<std::size_t>(*count));
  }
  return shape;
}

/// The header's text, and where the numbers begin.
std::string_view read_header(std::string_view bytes, std::size_t& position) {
  if (!bytes.starts_with(magic)) throw Error("it is no .npy file, which begins with \\x93NUMPY.");
  const std::size_t length_at = magic.size() + 2;
  const bool first_version = bytes.size() > magic.size() && bytes[magic.size()] == 1;
  const std::size_t length_bytes = first_version ? 2 : 4;
  std::uint32_t length = 0;
  if (bytes.size() < length_at + length_bytes) throw Error("it ends amid its header.");
  std::memcpy(&length, bytes.data() + length_at, length_bytes);
  position = length_at + length_bytes + length;
  if (position > bytes.size()) throw Error("it ends amid its header.");
  return bytes.substr(length_at + length_bytes, length);
}

template <typename Number>
std::vector<double> take(std::string_view bytes, std::size_t count) {
  if (bytes.size() / sizeof(Number) < count)
    throw Error("its header announces {} numbers, but it holds {}.", count, bytes.size() / sizeof(Number));
  std::vector<double> numbers(count);
  for (std::size_t i = 0; i < count; ++i) {
    Number number;
    std::memcpy(&number, bytes.data() + i * sizeof(Number), sizeof(Number));
    if (!std::isfinite(number)) throw Error("its numbers must be finite; number {} is {}.", i, number);
    numbers[i] = number;
  }
  return numbers;
}

}  // namespace

NumberArray parse_npy(std::string_view bytes) {
  std::size_t position = 0;
  const std::string_view header = read_header(bytes, position);
  const std::string_view type = value_of(header, "'descr'", ",");
  if (type != "'<f8'" && type != "'<f4'")
    throw Error("its numbers must be little-endian float32 or float64; got {}.", base::shortened(type, 40));
  if (!value_of(header, "'fortran_order'", ",").starts_with("False"))
    throw Error("its rows must follow each other (C order); save numpy.ascontiguousarray of the array.");
  NumberArray array;
  array.shape = read_shape(header);
  std::size_t count = 1;
  for (const std::size_t length : array.shape) {
    count *= length;
    if (count > most_numbers) throw Error("it announces more than {} numbers.", most_numbers);
  }
  const std::string_view body = bytes.substr(position);
  array.numbers = type == "'<f8'" ? take<double>(body, count) : take<float>(body, count);
  return array;
}

std::string to_npy(const NumberArray& array) {
  std::string header = fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}{}), }}",
                                   fmt::join(array.shape, ", "), array.shape.size() == 1 ? "," : "");
  // The numbers begin at a multiple of 64 bytes.
  const std::size_t before = magic.size() + 4;
  header.append(63 - (before + header.size()) % 64, ' ');
  header.push_back('\n');
  std::string bytes(magic);
  bytes += {'\1', '\0', static_cast<char>(header.size() & 255U), static_cast<char>(header.size() >> 8U)};
  bytes += header;
  bytes.append(reinterpret_cast<const char*>(array.numbers.data()), array.numbers.size() * sizeof(double));
  return bytes;
}

}  // namespace mesograin::io

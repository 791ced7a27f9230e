// Well-formed UTF-8 as the Unicode Standard's table 3-7 has it: no overlong form, no surrogate, nothing beyond
// U+10FFFF.
#include "base/readable.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace mesograin::base {
namespace {

unsigned byte_at(std::string_view bytes, std::size_t index) {
  return index < bytes.size() ? static_cast<unsigned char>(bytes[index]) : 0U;
}

bool continues(unsigned byte) { return (byte & 0xC0U) == 0x80U; }

/// How many bytes the well-formed character of several bytes at the front takes; 0 if there is none.
std::size_t long_character(std::string_view bytes) {
  const unsigned first = byte_at(bytes, 0);
  const unsigned second = byte_at(bytes, 1);
  if (first < 0xC2U || first > 0xF4U || !continues(second)) return 0;
  if (first < 0xE0U) return 2;
  if (!continues(byte_at(bytes, 2))) return 0;
  if (first < 0xF0U) {
    const bool overlong = first == 0xE0U && second < 0xA0U;
    const bool surrogate = first == 0xEDU && second > 0x9FU;
    return overlong || surrogate ? 0 : 3;
  }
  const bool overlong = first == 0xF0U && second < 0x90U;
  const bool beyond = first == 0xF4U && second > 0x8FU;
  return overlong || beyond || !continues(byte_at(bytes, 3)) ? 0 : 4;
}

bool is_shown(char byte) {
  const auto value = static_cast<unsigned char>(byte);
  return (value >= 0x20U && value < 0x7FU) || byte == '\n' || byte == '\t';
}

}  // namespace

std::string readable(std::string_view bytes) {
  std::string text;
  text.reserve(bytes.size());
  while (!bytes.empty()) {
    const std::size_t length = is_shown(bytes.front()) ? 1 : long_character(bytes);
    if (length > 0)
      text += bytes.substr(0, length);
    else
      fmt::format_to(std::back_inserter(text), "\\x{:02x}", byte_at(bytes, 0));
    bytes.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return text;
}

std::string shortened(std::string_view text, std::size_t most) {
  if (text.size() <= most) return std::string(text);
  while (most > 0 && continues(byte_at(text, most))) --most;
  return std::string(text.substr(0, most)) + "...";
}

}  // namespace mesograin::base

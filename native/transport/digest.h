// Names content by what it is: two 64-bit sums of Fowler, Noll and Vo (FNV-1a, draft-eastlake-fnv, section 2).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace mesograin::transport {

class Digest {
 public:
  void add(std::string_view bytes);

  template <typename Number>
  void add_numbers(const std::vector<Number>& numbers) {
    add({reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)});
  }

  /// 32 hexadecimal digits.
  std::string name() const;

 private:
  std::array<std::uint64_t, 2> sums_{0xCBF29CE484222325U, 0x84222325CBF29CE4U};
};

}  // namespace mesograin::transport

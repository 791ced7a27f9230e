// Two sums that start and mix differently: what agrees in both is the same.
#include "transport/digest.h"

#include <fmt/format.h>

namespace mesograin::transport {

void Digest::add(std::string_view bytes) {
  constexpr std::uint64_t prime = 0x100000001B3U;
  for (const char byte : bytes) {
    const auto value = static_cast<unsigned char>(byte);
    sums_[0] = (sums_[0] ^ value) * prime;
    sums_[1] = (sums_[1] ^ (value + (sums_[0] >> 32U))) * prime;
  }
}

std::string Digest::name() const { return fmt::format("{:016x}{:016x}", sums_[0], sums_[1]); }

}  // namespace mesograin::transport

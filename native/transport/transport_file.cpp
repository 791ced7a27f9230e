// Sources go in half precision, as the device has them.
#include "transport/transport_file.h"

#include <cstdint>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <type_traits>

#include "transport/digest.h"
#include "transport/octahedron.h"
#include "transport/surface.h"

namespace mesograin::transport {
namespace {

constexpr std::string_view title = "mesograin transport 6\n";
constexpr std::size_t name_length = 32;

template <typename Value>
void put(std::string& bytes, const Value& value) {
  static_assert(std::is_trivially_copyable_v<Value>);
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void put_floats(std::string& bytes, const std::vector<float>& numbers) {
  bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(float));
}

/// Takes values off the front; what is not there makes it fail.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  bool failed() const { return failed_; }
  bool done() const { return bytes_.empty(); }

  template <typename Value>
  void take(Value* values, std::size_t count) {
    if (failed_ || bytes_.size() / sizeof(Value) < count) {
      failed_ = true;
      return;
    }
    std::memcpy(values, bytes_.data(), count * sizeof(Value));
    bytes_.remove_prefix(count * sizeof(Value));
  }

  template <typename Value>
  std::vector<Value> take(std::size_t count) {
    if (failed_ || bytes_.size() / sizeof(Value) < count) {
      failed_ = true;
      return {};
    }
    std::vector<Value> values(count);
    take(values.data(), count);
    return values;
  }

 private:
  std::string_view bytes_;
  bool failed_ = false;
};

std::string sum_of(std::string_view bytes) {
  Digest digest;
  digest.add(bytes);
  return digest.name();
}

}  // namespace

std::string to_bytes(const StoredTransport& stored, std::string_view about) {
  std::string bytes(title);
  bytes.append(about);
  bytes.push_back('\0');
  put(bytes, stored.size);
  put(bytes, stored.lower);
  put(bytes, stored.spacing);
  put(bytes, stored.unit);
  put(bytes, stored.axes);
  put(bytes, stored.mean_chord);
  put(bytes, stored.terms);
  put(bytes, stored.channels);
  put(bytes, stored.convex);
  put(bytes, stored.has_unscattered);
  put_floats(bytes, stored.distances);
  for (const float source : stored.sources) put(bytes, glm::packHalf1x16(source));
  put_floats(bytes, stored.lobes);
  return bytes + sum_of(bytes);
}

std::optional<StoredTransport> from_bytes(std::string_view bytes, std::string_view about) {
  if (bytes.size() < name_length || !bytes.starts_with(title)) return std::nullopt;
  const std::string_view sum = bytes.substr(bytes.size() - name_length);
  bytes.remove_suffix(name_length);
  if (sum_of(bytes) != sum) return std::nullopt;
  bytes.remove_prefix(title.size());
  if (!bytes.starts_with(about) || bytes.size() <= about.size() || bytes[about.size()] != '\0') return std::nullopt;
  Reader reader(bytes.substr(about.size() + 1));
  StoredTransport stored;
  reader.take(&stored.size, 1);
  reader.take(&stored.lower, 1);
  reader.take(&stored.spacing, 1);
  reader.take(&stored.unit, 1);
  reader.take(&stored.axes, 1);
  reader.take(&stored.mean_chord, 1);
  reader.take(&stored.terms, 1);
  reader.take(&stored.channels, 1);
  reader.take(&stored.convex, 1);
  reader.take(&stored.has_unscattered, 1);
  if (reader.failed()) return std::nullopt;
  const std::size_t nodes = stored.nodes();
  const glm::ivec3 surface = surface_size(stored.size);
  const auto terms = static_cast<std::size_t>(stored.terms);
  stored.distances = reader.take<float>(static_cast<std::size_t>(surface.x) * static_cast<std::size_t>(surface.y) *
                                        static_cast<std::size_t>(surface.z));
  for (const std::uint16_t half : reader.take<std::uint16_t>(nodes * terms))
    stored.sources.push_back(glm::unpackHalf1x16(half));
  stored.lobes = reader.take<float>(terms * static_cast<std::size_t>(stored.channels) * octahedron_texels);
  if (reader.failed() || !reader.done()) return std::nullopt;
  return stored;
}

}  // namespace mesograin::transport

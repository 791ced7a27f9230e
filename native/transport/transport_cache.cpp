// Files named by the content that they are computed from.
#include "transport/transport_cache.h"

#include <algorithm>
#include <cstdlib>
#include <system_error>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "transport/transport_file.h"

namespace mesograin::transport {
namespace {

namespace fs = std::filesystem;

constexpr const char* suffix = ".transport";

}  // namespace

fs::path TransportCache::default_folder() {
  const char* const chosen = std::getenv("XDG_CACHE_HOME");
  const char* const home = std::getenv("HOME");
  const fs::path base =
      chosen != nullptr && *chosen != '\0' ? fs::path(chosen) : fs::path(home != nullptr ? home : ".") / ".cache";
  return base / "mesograin" / "transport";
}

fs::path TransportCache::path(const std::string& name) const { return folder_ / (name + suffix); }

std::optional<StoredTransport> TransportCache::find(const std::string& name, const std::string& about) const {
  const fs::path file = path(name);
  std::error_code error;
  fs::last_write_time(file, fs::file_time_type::clock::now(), error);
  if (error) return std::nullopt;
  try {
    if (std::optional<StoredTransport> stored = from_bytes(base::read_file(file), about)) return stored;
  } catch (const Error&) {
    return std::nullopt;
  }
  fs::remove(file, error);
  return std::nullopt;
}

void TransportCache::keep(const std::string& name, const std::string& about, const StoredTransport& stored) const {
  std::error_code error;
  fs::create_directories(folder_, error);
  try {
    base::write_file_atomically(path(name), to_bytes(stored, about));
  } catch (const Error&) {
    return;
  }
  trim();
}

void TransportCache::trim() const {
  struct File {
    fs::file_time_type used;
    std::uintmax_t bytes;
    fs::path path;
  };
  std::vector<File> files;
  std::uintmax_t sum = 0;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_, error)) {
    if (entry.path().extension() != suffix) continue;
    std::error_code gone;  // by another process, meanwhile
    const File file{entry.last_write_time(gone), entry.file_size(gone), entry.path()};
    if (gone) continue;
    files.push_back(file);
    sum += file.bytes;
  }
  std::sort(files.begin(), files.end(), [](const File& a, const File& b) { return a.used < b.used; });
  for (const File& file : files) {
    if (sum <= limit_) break;
    fs::remove(file.path, error);
    sum -= file.bytes;
  }
}

}  // namespace mesograin::transport

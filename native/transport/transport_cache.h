// Transport that was computed once, kept in a folder of bounded size that all programs of Mesograin share: the longest
// unused goes first.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "transport/stored_transport.h"

namespace mesograin::transport {

class TransportCache {
 public:
  static constexpr std::uintmax_t default_limit = 256ULL * 1024 * 1024;

  /// mesograin/transport in the user's cache folder: $XDG_CACHE_HOME, else ~/.cache.
  static std::filesystem::path default_folder();

  /// `limit`: bytes that all files together may take.
  explicit TransportCache(std::filesystem::path folder = default_folder(), std::uintmax_t limit = default_limit)
      : folder_(std::move(folder)), limit_(limit) {}

  /// What was kept under `name`, marked as just used. Nothing if there is none or it is damaged: then it is removed.
  std::optional<StoredTransport> find(const std::string& name, const std::string& about) const;

  /// Keeps it. Where that cannot be done it will be computed again, and nothing else happens.
  void keep(const std::string& name, const std::string& about, const StoredTransport& stored) const;

 private:
  std::filesystem::path path(const std::string& name) const;
  void trim() const;

  std::filesystem::path folder_;
  std::uintmax_t limit_;
};

}  // namespace mesograin::transport

// Walks of the bodies that were asked for last, as many as fit into some memory: the longest unused goes first.
#pragma once

#include <cstddef>
#include <list>
#include <memory>
#include <string>

#include "transport/walks.h"

namespace mesograin::transport {

class WalksShelf {
 public:
  static constexpr std::size_t default_limit = 384ULL * 1024 * 1024;

  explicit WalksShelf(std::size_t limit = default_limit) : limit_(limit) {}

  /// Those that stand under `name`, if any.
  std::shared_ptr<Walks> find(const std::string& name);

  void put(const std::string& name, std::shared_ptr<Walks> walks);

  /// Lets go of what is too much by now; what was asked for last stays.
  void trim();

 private:
  struct Book {
    std::string name;
    std::shared_ptr<Walks> walks;
  };

  std::size_t limit_;
  std::list<Book> books_;  // the latest first
};

}  // namespace mesograin::transport

// Walks of the bodies that were asked for last, as many as fit into some memory: the longest unused goes first. Those
// of bodies that are in no scene any more have little of it: what was edited seldom comes back.
#pragma once

#include <cstddef>
#include <functional>
#include <list>
#include <memory>
#include <string>

#include "transport/walks.h"

namespace mesograin::transport {

class WalksShelf {
 public:
  static constexpr std::size_t default_limit = 384ULL * 1024 * 1024;

  /// One edit back, of a grain that is not thick.
  static constexpr std::size_t default_limit_of_gone = 64ULL * 1024 * 1024;

  explicit WalksShelf(std::size_t limit = default_limit, std::size_t limit_of_gone = default_limit_of_gone)
      : limit_(limit), limit_of_gone_(limit_of_gone) {}

  /// Those of `body` that have this `quality`, if any.
  std::shared_ptr<Walks> find(const std::string& body, const std::string& quality);

  void put(const std::string& body, const std::string& quality, std::shared_ptr<Walks> walks);

  /// Lets go of what is too much by now; what was asked for last stays while it is in use. `in_use`: whether a body is
  /// in a scene.
  void trim(const std::function<bool(const std::string& body)>& in_use);

  std::size_t bytes() const;

 private:
  struct Book {
    std::string body;
    std::string quality;
    std::shared_ptr<Walks> walks;
  };

  std::size_t limit_;
  std::size_t limit_of_gone_;
  std::list<Book> books_;  // the latest first
};

}  // namespace mesograin::transport

// Compiled programs, as many as there is use for: where there are many, the longest unused go first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "gl/program.h"

namespace mesograin::render {

/// Lives on the context's thread.
class ProgramShelf {
 public:
  /// A program takes 0.5 to 1.4 MB of a software device (tests/bench/programs.py), one of transport more: 4.3 MB in the
  /// mean of a day's (tests/window/monkey.py), so that these take 100 MB. What is in use stays, however many.
  static constexpr std::size_t default_limit = 24;

  /// The latest samples whose programs stay, however many these are: views take turns.
  static constexpr std::uint64_t in_use = 16;

  explicit ProgramShelf(std::size_t limit = default_limit) : limit_(limit) {}

  /// The one of that name, compiled if there is none. It stays until in_use samples later, at least. Throws as
  /// gl::Program.
  const gl::Program& find(const std::string& name, const std::vector<gl::Stage>& stages);

  /// Of any view. Frees what is too much by now.
  void begin_sample();

  std::size_t compiled() const { return compiled_; }
  std::size_t freed() const { return compiled_ - books_.size(); }

 private:
  struct Book {
    gl::Program program;
    std::uint64_t used;  // in which sample
  };

  std::size_t limit_;
  std::map<std::string, Book> books_;
  std::uint64_t sample_ = 0;
  std::size_t compiled_ = 0;
};

}  // namespace mesograin::render

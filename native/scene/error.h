// The one exception for what a user can cause: a sentence that says what was needed, what came and what to do.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace mesograin {

class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& sentence) : std::runtime_error(sentence) {}

  template <typename... Arguments>
  explicit Error(fmt::format_string<Arguments...> sentence, Arguments&&... arguments)
      : std::runtime_error(fmt::format(sentence, std::forward<Arguments>(arguments)...)) {}
};

}  // namespace mesograin

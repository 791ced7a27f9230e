// The one exception for what a user can cause: a sentence that says what was needed, what came and what to do.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string_view>
#include <utility>

namespace mesograin {

/// Its sentence is readable (see base/readable.h), whatever bytes of a file it quotes.
class Error : public std::runtime_error {
 public:
  explicit Error(std::string_view sentence);

  template <typename... Arguments>
  explicit Error(fmt::format_string<Arguments...> sentence, Arguments&&... arguments)
      : Error(std::string_view(fmt::format(sentence, std::forward<Arguments>(arguments)...))) {}
};

}  // namespace mesograin

// Bytes of files as text that can be shown: whatever a sentence quotes, the sentence itself is UTF-8.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace mesograin::base {

/// `bytes` with everything but printable UTF-8, line ends and tabs written as \xNN.
std::string readable(std::string_view bytes);

/// The first `most` bytes of readable text and "...", no character cut in two; the whole if it is no longer.
std::string shortened(std::string_view text, std::size_t most);

}  // namespace mesograin::base

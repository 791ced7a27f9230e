// Turns the device's "out of memory" into an Error right where memory was asked for.
#pragma once

#include <cstddef>

namespace mesograin::gl {

/// Throws Error if the last allocation failed for want of memory, std::logic_error for any other GL error pending.
/// `remedy` is what would need less of it, such as "render a smaller picture".
void require_memory(const char* what, std::size_t bytes, const char* remedy);

}  // namespace mesograin::gl

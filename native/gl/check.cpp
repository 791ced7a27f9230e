// Looks for GL_OUT_OF_MEMORY after an allocation.
#include "gl/check.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <stdexcept>

#include "base/error.h"

namespace mesograin::gl {

void require_memory(const char* what, std::size_t bytes, const char* remedy) {
  const GLenum error = glGetError();
  if (error == GL_NO_ERROR) return;
  if (error == GL_OUT_OF_MEMORY)
    throw Error("The graphics device has no room for {} of {:.1f} MB: {}.", what, static_cast<double>(bytes) / 1e6,
                remedy);
  throw std::logic_error(fmt::format("GL error {:#x} around the allocation of {}", error, what));
}

}  // namespace mesograin::gl

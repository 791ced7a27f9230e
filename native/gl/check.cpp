// Looks for GL_OUT_OF_MEMORY after an allocation.
#include "gl/check.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <stdexcept>

#include "scene/error.h"

namespace mesograin::gl {

void require_memory(const char* what, std::size_t bytes) {
  const GLenum error = glGetError();
  if (error == GL_NO_ERROR) return;
  if (error == GL_OUT_OF_MEMORY)
    throw Error("The graphics device has no room for {} of {:.1f} MB; render at a smaller size.", what,
                static_cast<double>(bytes) / 1e6);
  throw std::logic_error(fmt::format("GL error {:#x} around the allocation of {}", error, what));
}

}  // namespace mesograin::gl

// Device storage, immutable but for what is written later.
#include "gl/buffer.h"

#include <algorithm>

#include "gl/check.h"

namespace mesograin::gl {

GLuint Buffer::Traits::create() {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  return name;
}

void Buffer::Traits::destroy(GLuint name) { glDeleteBuffers(1, &name); }

Buffer::Buffer(const void* data, std::size_t bytes) : bytes_(bytes) {
  // A buffer of no bytes is an error in GL, but an empty list of lights is not one here.
  constexpr char nothing[16] = {};
  if (bytes == 0)
    glNamedBufferStorage(handle_.name(), sizeof(nothing), nothing, 0);
  else
    glNamedBufferStorage(handle_.name(), static_cast<GLsizeiptr>(bytes), data, 0);
  require_memory("a mesh", bytes, "draw fewer triangles");
}

Buffer::Buffer(std::size_t bytes) : bytes_(bytes) {
  glNamedBufferStorage(handle_.name(), static_cast<GLsizeiptr>(std::max(bytes, std::size_t{1})), nullptr,
                       GL_DYNAMIC_STORAGE_BIT);
  require_memory("light between grains", bytes, "show fewer grains");
}

void Buffer::write(std::size_t first, const void* data, std::size_t bytes) {
  glNamedBufferSubData(handle_.name(), static_cast<GLintptr>(first), static_cast<GLsizeiptr>(bytes), data);
}

void Buffer::bind_storage(GLuint binding) const { glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, handle_.name()); }

void Buffer::read(void* data, std::size_t bytes) const {
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glGetNamedBufferSubData(handle_.name(), 0, static_cast<GLsizeiptr>(bytes), data);
}

}  // namespace mesograin::gl

// Vertex, index or storage data on the device.
#pragma once

#include <cstddef>
#include <vector>

#include "gl/handle.h"

namespace mesograin::gl {

class Buffer {
 public:
  Buffer(const void* data, std::size_t bytes);

  template <typename Value>
  explicit Buffer(const std::vector<Value>& values) : Buffer(values.data(), values.size() * sizeof(Value)) {}

  /// Room for what is written later.
  explicit Buffer(std::size_t bytes);
  void write(std::size_t first, const void* data, std::size_t bytes);

  GLuint name() const { return handle_.name(); }
  std::size_t bytes() const { return bytes_; }

  void bind_storage(GLuint binding) const;

  /// Copies the first `bytes` back; waits for the device.
  void read(void* data, std::size_t bytes) const;

 private:
  struct Traits {
    static GLuint create();
    static void destroy(GLuint name);
  };
  Handle<Traits> handle_;
  std::size_t bytes_;
};

}  // namespace mesograin::gl

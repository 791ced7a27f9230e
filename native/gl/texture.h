// A 2-D texture with fixed storage.
#pragma once

#include <glm/vec2.hpp>

#include "gl/handle.h"

namespace mesograin::gl {

class Texture {
 public:
  /// One level of `format` (GL_RGBA32F, GL_DEPTH_COMPONENT32F, ...). Throws Error if the size is beyond the device's.
  Texture(GLenum format, int width, int height);

  GLuint name() const { return handle_.name(); }
  int width() const { return width_; }
  int height() const { return height_; }

  /// Uploads tightly packed rows, first row at v = 0.
  void upload(GLenum components, GLenum type, const void* texels);

  /// Linear or nearest filtering, coordinates clamped to the edge.
  void sample_linearly(bool linear);

  void bind(GLuint unit) const;

 private:
  struct Traits {
    static GLuint create();
    static void destroy(GLuint name);
  };
  Handle<Traits> handle_;
  int width_;
  int height_;
};

}  // namespace mesograin::gl

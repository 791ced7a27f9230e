// A 2-D texture with fixed storage.
#pragma once

#include "gl/texture_storage.h"

namespace mesograin::gl {

class Texture : public TextureStorage<GL_TEXTURE_2D> {
 public:
  /// One level of `format` (GL_RGBA32F, GL_DEPTH_COMPONENT32F, ...). Throws Error if the size is beyond the device's.
  Texture(GLenum format, int width, int height);

  /// Uploads tightly packed rows, first row at v = 0.
  void upload(GLenum components, GLenum type, const void* texels);

  /// To zero.
  void clear() const { glClearTexImage(name(), 0, GL_RGBA, GL_FLOAT, nullptr); }

  /// For compute shaders to read and write, as texels of its own format.
  void bind_image(GLuint unit, GLenum format) const {
    glBindImageTexture(unit, name(), 0, GL_FALSE, 0, GL_READ_WRITE, format);
  }

  /// Whether its texels are integers, for a usampler2D.
  bool holds_numbers() const { return holds_numbers_; }

  /// Linear or nearest filtering.
  void sample_linearly(bool linear) { filter(linear ? GL_LINEAR : GL_NEAREST); }

  /// Its one component is read as all three of a colour.
  void show_first_as_all() {
    glTextureParameteri(name(), GL_TEXTURE_SWIZZLE_G, GL_RED);
    glTextureParameteri(name(), GL_TEXTURE_SWIZZLE_B, GL_RED);
  }

  /// What lies beyond its edges: GL_REPEAT, GL_MIRRORED_REPEAT, ...
  void wrap(GLint how) {
    glTextureParameteri(name(), GL_TEXTURE_WRAP_S, how);
    glTextureParameteri(name(), GL_TEXTURE_WRAP_T, how);
  }

 private:
  bool holds_numbers_;
};

}  // namespace mesograin::gl

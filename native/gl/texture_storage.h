// What textures of every kind have in common: one owner, fixed storage of one level, coordinates clamped to the edge.
#pragma once

#include "gl/handle.h"

namespace mesograin::gl {

/// The base of textures of one target; they give it its storage.
template <GLenum target>
class TextureStorage {
 public:
  GLuint name() const { return handle_.name(); }
  int width() const { return width_; }
  int height() const { return height_; }

  void bind(GLuint unit) const { glBindTextureUnit(unit, name()); }

 protected:
  /// Nearest filtering.
  TextureStorage(int width, int height) : width_(width), height_(height) {
    filter(GL_NEAREST);
    glTextureParameteri(name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  }

  void filter(GLint filter) {
    glTextureParameteri(name(), GL_TEXTURE_MIN_FILTER, filter);
    glTextureParameteri(name(), GL_TEXTURE_MAG_FILTER, filter);
  }

 private:
  struct Traits {
    static GLuint create() {
      GLuint name = 0;
      glCreateTextures(target, 1, &name);
      return name;
    }
    static void destroy(GLuint name) { glDeleteTextures(1, &name); }
  };
  Handle<Traits> handle_;
  int width_;
  int height_;
};

}  // namespace mesograin::gl

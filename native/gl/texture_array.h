// A stack of equally sized 2-D textures, read in a shader by layer.
#pragma once

#include "gl/handle.h"

namespace mesograin::gl {

class TextureArray {
 public:
  /// One level of `format`, nearest filtering, coordinates clamped. Throws Error if the size is beyond the device's.
  TextureArray(GLenum format, int width, int height, int layers);

  GLuint name() const { return handle_.name(); }
  int width() const { return width_; }
  int height() const { return height_; }
  int layers() const { return layers_; }

  /// Waits for the drawing and copies one layer as float RGBA into `texels`, first row y = 0.
  void read(int layer, float* texels) const;

  void bind(GLuint unit) const { glBindTextureUnit(unit, handle_.name()); }

 private:
  struct Traits {
    static GLuint create();
    static void destroy(GLuint name);
  };
  Handle<Traits> handle_;
  int width_;
  int height_;
  int layers_;
};

}  // namespace mesograin::gl

// A stack of equally sized 2-D textures, read in a shader by layer.
#pragma once

#include "gl/texture_storage.h"

namespace mesograin::gl {

class TextureArray : public TextureStorage<GL_TEXTURE_2D_ARRAY> {
 public:
  /// One level of `format`, nearest filtering. Throws Error if there are more layers than the device draws.
  TextureArray(GLenum format, int width, int height, int layers);

  int layers() const { return layers_; }

  /// Uploads tightly packed rows of one layer, first row at v = 0.
  void upload(int layer, GLenum components, GLenum type, const void* texels);

  /// One layer, for compute shaders to read and write, as texels of its own format.
  void bind_image(GLuint unit, int layer, GLenum format) const {
    glBindImageTexture(unit, name(), 0, GL_FALSE, layer, GL_READ_WRITE, format);
  }

  /// Waits for the drawing and copies one layer as float RGBA into `texels`, first row y = 0.
  void read(int layer, float* texels) const;

 private:
  int layers_;
};

}  // namespace mesograin::gl

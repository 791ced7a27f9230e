// A 3-D texture with fixed storage.
#pragma once

#include "gl/texture_storage.h"

namespace mesograin::gl {

class Volume : public TextureStorage<GL_TEXTURE_3D> {
 public:
  /// One level of `format` (GL_RGBA16F, GL_R16F, ...), linear filtering. Throws Error if the size is beyond the
  /// device's.
  Volume(GLenum format, int width, int height, int depth);

  /// Uploads tightly packed texels, x fastest, then y.
  void upload(GLenum components, const float* texels);

  /// For compute shaders to write to all of it, as texels of its own format.
  void bind_image(GLuint unit, GLenum format) const;

  int depth() const { return depth_; }

 private:
  int depth_;
};

}  // namespace mesograin::gl

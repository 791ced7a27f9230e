// A 3-D texture with fixed storage.
#pragma once

#include "gl/texture_storage.h"

namespace mesograin::gl {

class Volume : public TextureStorage<GL_TEXTURE_3D> {
 public:
  /// One level of `format` (GL_RGBA16F, GL_R16F, ...), linear filtering, but for whole numbers (GL_R32UI). Throws Error
  /// if the size is beyond the device's.
  Volume(GLenum format, int width, int height, int depth);

  /// Uploads tightly packed texels, x fastest, then y.
  void upload(GLenum components, const float* texels);

  /// All of a volume of whole numbers is 0 again.
  void clear();

  /// For compute shaders to read and write all of it, as texels of its own format.
  void bind_image(GLuint unit, GLenum format) const;

  /// What reads it in a shader.
  GLenum sampler_type() const { return whole_numbers_ ? GL_UNSIGNED_INT_SAMPLER_3D : GL_SAMPLER_3D; }

  int depth() const { return depth_; }

 private:
  int depth_;
  bool whole_numbers_;
};

}  // namespace mesograin::gl

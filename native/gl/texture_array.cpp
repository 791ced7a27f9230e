// Fixed storage of a texture array.
#include "gl/texture_array.h"

#include "gl/check.h"
#include "scene/error.h"

namespace mesograin::gl {

GLuint TextureArray::Traits::create() {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &name);
  return name;
}

void TextureArray::Traits::destroy(GLuint name) { glDeleteTextures(1, &name); }

TextureArray::TextureArray(GLenum format, int width, int height, int layers)
    : width_(width), height_(height), layers_(layers) {
  GLint most_layers = 0;
  glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &most_layers);
  if (layers > most_layers) throw Error("This device draws at most {} lights; got {}.", most_layers, layers);
  glTextureStorage3D(handle_.name(), 1, format, width, height, layers);
  require_memory("light maps", static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                                   static_cast<std::size_t>(layers) * 16);
  glTextureParameteri(handle_.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(handle_.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTextureParameteri(handle_.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(handle_.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void TextureArray::read(int layer, float* texels) const {
  const GLsizei bytes = width_ * height_ * 4 * static_cast<GLsizei>(sizeof(float));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureSubImage(handle_.name(), 0, 0, 0, layer, width_, height_, 1, GL_RGBA, GL_FLOAT, bytes, texels);
}

}  // namespace mesograin::gl

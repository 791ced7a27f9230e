// Fixed storage of a texture array.
#include "gl/texture_array.h"

#include "base/error.h"
#include "gl/check.h"

namespace mesograin::gl {

TextureArray::TextureArray(GLenum format, int width, int height, int layers)
    : TextureStorage(width, height), layers_(layers) {
  GLint most_layers = 0;
  glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &most_layers);
  if (layers > most_layers) throw Error("This device draws at most {} lights; got {}.", most_layers, layers);
  glTextureStorage3D(name(), 1, format, width, height, layers);
  // One for each grain and light, whatever the size of the picture.
  require_memory(
      "light maps",
      static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * static_cast<std::size_t>(layers) * 16,
      "draw fewer grains or lights, or choose model_1, which needs none");
}

void TextureArray::upload(int layer, GLenum components, GLenum type, const void* texels) {
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage3D(name(), 0, 0, 0, layer, width(), height(), 1, components, type, texels);
}

void TextureArray::read(int layer, float* texels) const {
  const GLsizei bytes = width() * height() * 4 * static_cast<GLsizei>(sizeof(float));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureSubImage(name(), 0, 0, 0, layer, width(), height(), 1, GL_RGBA, GL_FLOAT, bytes, texels);
}

}  // namespace mesograin::gl

// Fixed 2-D texture storage and upload.
#include "gl/texture.h"

#include "base/error.h"
#include "gl/check.h"

namespace mesograin::gl {

Texture::Texture(GLenum format, int width, int height)
    : TextureStorage(width, height), holds_numbers_(format == GL_R32UI || format == GL_RGB32UI) {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  if (width < 1 || height < 1 || width > largest || height > largest)
    throw Error("An image must be between 1 and {} pixels wide and high on this device; got {} x {}.", largest, width,
                height);
  glTextureStorage2D(name(), 1, format, width, height);
  require_memory("a texture", static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 16,
                 "render a smaller picture, or bake a smaller texture");
}

void Texture::upload(GLenum components, GLenum type, const void* texels) {
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(name(), 0, 0, 0, width(), height(), components, type, texels);
}

}  // namespace mesograin::gl

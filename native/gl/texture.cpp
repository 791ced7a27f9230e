// Fixed 2-D texture storage, filtering and upload.
#include "gl/texture.h"

#include "gl/check.h"
#include "scene/error.h"

namespace mesograin::gl {

GLuint Texture::Traits::create() {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  return name;
}

void Texture::Traits::destroy(GLuint name) { glDeleteTextures(1, &name); }

Texture::Texture(GLenum format, int width, int height) : width_(width), height_(height) {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  if (width < 1 || height < 1 || width > largest || height > largest)
    throw Error("An image must be between 1 and {} pixels wide and high on this device; got {} x {}.", largest, width,
                height);
  glTextureStorage2D(handle_.name(), 1, format, width, height);
  require_memory("a texture", static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 16);
  sample_linearly(false);
  glTextureParameteri(handle_.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(handle_.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void Texture::upload(GLenum components, GLenum type, const void* texels) {
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(handle_.name(), 0, 0, 0, width_, height_, components, type, texels);
}

void Texture::sample_linearly(bool linear) {
  const GLint filter = linear ? GL_LINEAR : GL_NEAREST;
  glTextureParameteri(handle_.name(), GL_TEXTURE_MIN_FILTER, filter);
  glTextureParameteri(handle_.name(), GL_TEXTURE_MAG_FILTER, filter);
}

void Texture::bind(GLuint unit) const { glBindTextureUnit(unit, handle_.name()); }

}  // namespace mesograin::gl

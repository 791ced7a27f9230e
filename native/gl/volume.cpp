// Fixed 3-D texture storage and upload.
#include "gl/volume.h"

#include "base/error.h"
#include "gl/check.h"

namespace mesograin::gl {

Volume::Volume(GLenum format, int width, int height, int depth)
    : TextureStorage(width, height), depth_(depth), whole_numbers_(format == GL_R32UI) {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &largest);
  if (width < 1 || height < 1 || depth < 1 || width > largest || height > largest || depth > largest)
    throw Error("A volume must be between 1 and {} texels along each side on this device; got {} x {} x {}.", largest,
                width, height, depth);
  if (!whole_numbers_) filter(GL_LINEAR);
  glTextureParameteri(name(), GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
  glTextureStorage3D(name(), 1, format, width, height, depth);
  require_memory(
      "a volume",
      static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * static_cast<std::size_t>(depth) * 8,
      "draw fewer kinds of grain by transport, or choose model_3");
}

void Volume::upload(GLenum components, const float* texels) {
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage3D(name(), 0, 0, 0, 0, width(), height(), depth_, components, GL_FLOAT, texels);
}

void Volume::clear() {
  const GLuint nothing = 0;
  glClearTexImage(name(), 0, GL_RED_INTEGER, GL_UNSIGNED_INT, &nothing);
}

void Volume::bind_image(GLuint unit, GLenum format) const {
  glBindImageTexture(unit, name(), 0, GL_TRUE, 0, GL_READ_WRITE, format);
}

}  // namespace mesograin::gl

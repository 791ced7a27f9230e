// Attaches, clears and reads render targets.
#include "gl/framebuffer.h"

#include <fmt/format.h>

#include <stdexcept>
#include <vector>

namespace mesograin::gl {

GLuint Framebuffer::Traits::create() {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  return name;
}

void Framebuffer::Traits::destroy(GLuint name) { glDeleteFramebuffers(1, &name); }

namespace {

bool has_stencil(const Texture* depth) {
  GLint bits = 0;
  if (depth != nullptr) glGetTextureLevelParameteriv(depth->name(), 0, GL_TEXTURE_STENCIL_SIZE, &bits);
  return bits > 0;
}

}  // namespace

Framebuffer::Framebuffer(std::initializer_list<const Texture*> colours, const Texture* depth)
    : width_(depth != nullptr ? depth->width() : (*colours.begin())->width()),
      height_(depth != nullptr ? depth->height() : (*colours.begin())->height()),
      colours_(static_cast<int>(colours.size())),
      has_depth_(depth != nullptr),
      has_stencil_(has_stencil(depth)) {
  std::vector<GLenum> attachments;
  for (const Texture* colour : colours) {
    attachments.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(attachments.size()));
    glNamedFramebufferTexture(handle_.name(), attachments.back(), colour->name(), 0);
  }
  const GLenum place = has_stencil_ ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT;
  if (depth != nullptr) glNamedFramebufferTexture(handle_.name(), place, depth->name(), 0);
  glNamedFramebufferDrawBuffers(handle_.name(), static_cast<GLsizei>(attachments.size()), attachments.data());
  require_complete();
}

Framebuffer::Framebuffer(const TextureArray& colours, int layer, const Texture& depth)
    : width_(colours.width()), height_(colours.height()), colours_(1), has_depth_(true), has_stencil_(false) {
  glNamedFramebufferTextureLayer(handle_.name(), GL_COLOR_ATTACHMENT0, colours.name(), 0, layer);
  glNamedFramebufferTexture(handle_.name(), GL_DEPTH_ATTACHMENT, depth.name(), 0);
  glNamedFramebufferDrawBuffer(handle_.name(), GL_COLOR_ATTACHMENT0);
  require_complete();
}

void Framebuffer::require_complete() const {
  const GLenum status = glCheckNamedFramebufferStatus(handle_.name(), GL_DRAW_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE) throw std::logic_error(fmt::format("incomplete framebuffer ({:#x})", status));
}

void Framebuffer::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, handle_.name());
  glViewport(0, 0, width_, height_);
}

void Framebuffer::clear(const float (&colour)[4]) const {
  clear_colour(colour);
  clear_depth();
}

void Framebuffer::clear_colour(const float (&colour)[4]) const {
  for (int i = 0; i < colours_; ++i) glClearNamedFramebufferfv(handle_.name(), GL_COLOR, i, colour);
}

void Framebuffer::clear_depth() const {
  constexpr float far_plane = 1.0F;
  if (has_stencil_)
    glClearNamedFramebufferfi(handle_.name(), GL_DEPTH_STENCIL, 0, far_plane, 0);
  else if (has_depth_)
    glClearNamedFramebufferfv(handle_.name(), GL_DEPTH, 0, &far_plane);
}

void Framebuffer::read(float* pixels, int colour) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, handle_.name());
  glReadBuffer(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(colour));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, GL_RGBA, GL_FLOAT, pixels);
}

}  // namespace mesograin::gl

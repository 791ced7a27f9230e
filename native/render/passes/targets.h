// What a view's passes draw into.
#pragma once

#include "gl/framebuffer.h"
#include "gl/texture.h"

namespace mesograin::render {

/// The passes of one sample share the depth and its stencil.
struct Targets {
  Targets(int width, int height)
      : position(GL_RGBA32F, width, height),
        normal(GL_RGBA32F, width, height),
        depth(GL_DEPTH32F_STENCIL8, width, height),
        sample(GL_RGBA32F, width, height),
        sum(GL_RGBA32F, width, height),
        surfaces({&position, &normal}, &depth),
        shade({&sample}, &depth),
        accumulate({&sum}) {}

  gl::Texture position;
  gl::Texture normal;
  gl::Texture depth;
  gl::Texture sample;  ///< free between samples
  gl::Texture sum;
  gl::Framebuffer surfaces;
  gl::Framebuffer shade;
  gl::Framebuffer accumulate;
};

}  // namespace mesograin::render

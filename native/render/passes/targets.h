// What a view's passes draw into.
#pragma once

#include <optional>

#include "gl/framebuffer.h"
#include "gl/texture.h"

namespace mesograin::render {

/// Where surfaces of facets draw what they mirror.
struct MirrorTargets {
  /// Beside the colour and the depth, which must outlive it.
  MirrorTargets(const gl::Texture& colour, const gl::Texture& depth)
      : radiance(GL_RGBA32F, colour.width(), colour.height()),
        looks(GL_RGBA32F, colour.width(), colour.height()),
        passed(GL_RGBA32F, colour.width(), colour.height()),
        shade({&colour, &radiance, &looks, &passed}, &depth) {}

  /// But for the colour.
  void clear() const {
    for (const gl::Texture* texture : {&radiance, &looks, &passed}) texture->clear();
  }

  gl::Texture radiance;  ///< of the world, if nothing stands in the way
  gl::Texture looks;     ///< along which, unit length; w: 1 where there is any
  gl::Texture passed;    ///< by what the radiance of an object is multiplied that does
  gl::Framebuffer shade;
};

/// Samples, added up.
struct Sum {
  Sum(int width, int height) : texture(GL_RGBA32F, width, height), accumulate({&texture}) {}

  gl::Texture texture;
  gl::Framebuffer accumulate;
};

/// The passes of one sample share the depth and its stencil.
struct Targets {
  /// `textured`: with where on their pictures surfaces are.
  Targets(int width, int height, bool textured)
      : position(GL_RGBA32F, width, height),
        normal(GL_RGBA32F, width, height),
        coordinates(textured ? std::make_optional<gl::Texture>(GL_RGBA32F, width, height) : std::nullopt),
        depth(GL_DEPTH32F_STENCIL8, width, height),
        sample(GL_RGBA32F, width, height),
        surfaces(textured ? gl::Framebuffer({&position, &normal, &*coordinates}, &depth)
                          : gl::Framebuffer({&position, &normal}, &depth)),
        shade({&sample}, &depth),
        sum(width, height) {}

  gl::Texture position;
  gl::Texture normal;
  std::optional<gl::Texture> coordinates;
  gl::Texture depth;
  gl::Texture sample;  ///< free between samples
  gl::Framebuffer surfaces;
  gl::Framebuffer shade;
  Sum sum;
  std::optional<MirrorTargets> mirror;  ///< of a sample that has Mirrors::hindered
  std::optional<MirrorTargets> behind;  ///< where what it met shows something behind itself; they take turns
};

}  // namespace mesograin::render

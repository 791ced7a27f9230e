// Where a pass draws: colour textures and, if there is one, a depth texture, with a stencil or without, all of one
// size.
#pragma once

#include <initializer_list>

#include "gl/handle.h"
#include "gl/texture.h"
#include "gl/texture_array.h"

namespace mesograin::gl {

class Framebuffer {
 public:
  /// The textures must outlive the framebuffer. Throws std::logic_error if they do not make a complete one.
  explicit Framebuffer(std::initializer_list<const Texture*> colours, const Texture* depth = nullptr);

  /// One layer of a texture array with a depth texture of the same size.
  Framebuffer(const TextureArray& colours, int layer, const Texture& depth);

  /// Makes it the target of drawing and sets the viewport to its size.
  void bind() const;

  /// Clears every colour, to zero unless said otherwise, the depth to the far plane and the stencil to 0.
  void clear(const float (&colour)[4] = {0.0F, 0.0F, 0.0F, 0.0F}) const;
  void clear_colour(const float (&colour)[4] = {0.0F, 0.0F, 0.0F, 0.0F}) const;
  void clear_depth() const;

  /// Waits for the drawing and copies a colour, by default the first, as float RGBA into `pixels`, (height, width, 4),
  /// first row y = 0.
  void read(float* pixels, int colour = 0) const;

 private:
  struct Traits {
    static GLuint create();
    static void destroy(GLuint name);
  };
  void require_complete() const;

  Handle<Traits> handle_;
  int width_;
  int height_;
  int colours_;
  bool has_depth_;
  bool has_stencil_;
};

}  // namespace mesograin::gl

// The rays that a projection sees along.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "render/bounds.h"

namespace mesograin::render {

struct PixelRay {
  glm::vec3 origin;
  glm::vec3 direction;  // unit length
  float farthest;
};

class PixelRays {
 public:
  /// Of a picture that is moved by `jitter`, in normalised device coordinates. Rays begin before `bounds`, so that the
  /// way there costs no precision.
  PixelRays(const glm::dmat4& anchor_to_clip, const glm::dvec2& size, const glm::dvec2& jitter, const Bounds& bounds);

  /// Through the middle of a pixel.
  PixelRay at(int x, int y) const { return at(glm::dvec2(x, y)); }

  /// Half a pixel around its middle is the pixel.
  PixelRay at(const glm::dvec2& pixel) const;

 private:
  glm::dmat4 clip_to_anchor_;
  glm::dvec2 scale_;
  glm::dvec2 offset_;
  glm::dvec3 middle_;
  double radius_;
};

}  // namespace mesograin::render

// Which part of the scene a picture shows, and so where light must be known.
#pragma once

#include <functional>
#include <glm/vec4.hpp>
#include <vector>

#include "gl/framebuffer.h"

namespace mesograin::render {

/// What must be known of an instance to know where light falls on it.
struct Receiver {
  glm::vec4 ball;  ///< holds it: xyz from the anchor, radius
  bool whole;      ///< all of it is lit where any of it is seen, as light goes through; else what is seen alone
  bool ground;     ///< it does not shade itself, and reaches far beyond all that may shade it
};

/// Balls that hold what a picture shows.
struct Receivers {
  std::vector<glm::vec4> grains;
  std::vector<glm::vec4> ground;

  bool empty() const { return grains.empty() && ground.empty(); }
  void clear() { *this = {}; }
};

/// `receiver` tells of an instance by its number.
Receivers receivers(const gl::Framebuffer& surfaces, int width, int height,
                    const std::function<Receiver(std::size_t instance)>& receiver);

}  // namespace mesograin::render

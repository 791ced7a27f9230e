// Smooths edges in a picture of few samples: what is seen beside a sample, within its pixel, costs one more ray and
// takes its light from the sample nearby that shows the same.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec4.hpp>
#include <vector>

#include "render/passes/array_visibility.h"
#include "render/passes/sample.h"
#include "render/passes/surface_pass.h"

namespace mesograin::render {

class SubpixelPass {
 public:
  /// After the surfaces are found. Rays cost little beside light that is gathered, and as much as all else where none
  /// is: then it does nothing. False if ended.
  bool look(const Sample& sample, const ArrayVisibility& arrays, SurfacePass& surfaces);

  /// What was shaded, all of it or a portion.
  void smooth(const Sample& sample);

  /// Whether the last sample had it.
  bool ran() const { return ran_; }

  /// That the last look took.
  double milliseconds() const { return milliseconds_; }

 private:
  static constexpr int places = 4;  // of a pixel, the sample's own among them

  /// A pixel that shows more than one thing.
  struct Edge {
    int x;
    std::array<std::uint8_t, places> shows;  // which of the nine samples around it, row by row
  };

  std::vector<std::vector<Edge>> rows_;
  std::vector<glm::vec4> shaded_;
  std::vector<glm::vec4> smoothed_;
  bool ran_ = false;
  double milliseconds_ = 0.0;
};

}  // namespace mesograin::render

// Draws the light maps that are out of date: of draws for each of their lights, of arrays' prototypes for the
// directions that their instances meet light from.
#pragma once

#include "render/passes/array_visibility.h"
#include "render/passes/sample.h"

namespace mesograin::render {

class LightMapPass {
 public:
  /// False if ended.
  bool run(const Sample& sample, const ArrayVisibility& arrays);

  /// In the last run.
  int maps_drawn() const { return maps_drawn_; }

 private:
  int maps_drawn_ = 0;
};

}  // namespace mesograin::render

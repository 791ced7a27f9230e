// Adds a sample to the sum, and resolves the mean.
#pragma once

#include "gl/program.h"
#include "gl/vertex_array.h"
#include "render/passes/targets.h"

namespace mesograin::render {

class AccumulatePass {
 public:
  AccumulatePass();

  /// Adds what was shaded. The `first` begins a new sum.
  void run(const Targets& targets, const Sum& sum, bool first);

  /// The mean of so many samples, (height, width, 4), first row at the top.
  void read(const Targets& targets, const Sum& sum, int samples, float* pixels);

 private:
  gl::Program accumulate_program_;
  gl::Program resolve_program_;
  gl::FullScreenTriangle full_screen_;
};

}  // namespace mesograin::render

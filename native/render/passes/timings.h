// How long the passes of the last sample took.
#pragma once

#include <string>
#include <vector>

#include "gl/timer.h"

namespace mesograin::render {

struct PassTiming {
  std::string pass;
  double milliseconds;
};

/// On the device.
struct PassTimers {
  gl::Timer light_maps;
  gl::Timer surfaces;
  gl::Timer shadows;
  gl::Timer shade;
  gl::Timer accumulate;
};

}  // namespace mesograin::render

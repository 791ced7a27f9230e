// How long a pass took on the device.
#pragma once

#include "gl/handle.h"

namespace mesograin::gl {

class Timer {
 public:
  void start() const;
  void stop() const;

  /// Milliseconds between start() and stop(); waits for the device.
  double milliseconds() const;

 private:
  struct Traits {
    static GLuint create();
    static void destroy(GLuint name);
  };
  Handle<Traits> begin_;
  Handle<Traits> end_;
};

}  // namespace mesograin::gl

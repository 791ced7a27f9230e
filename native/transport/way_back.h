// A ray from a place inside a body, back along the way that light comes there by: reflected inside, or out and in
// again.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "transport/body.h"
#include "transport/interface.h"
#include "transport/random.h"

namespace mesograin::transport {

/// A straight piece of it, inside.
struct Segment {
  glm::vec3 place;
  glm::vec3 direction;
  float end;  ///< length of the way up to here
};

struct WayBack {
  std::vector<Segment> segments;
  bool ends_outside = false;

  float length() const { return segments.empty() ? 0.0F : segments.back().end; }

  glm::vec3 place_at(float distance) const {
    float begin = 0.0F;
    for (const Segment& segment : segments) {
      if (distance <= segment.end) return segment.place + (distance - begin) * segment.direction;
      begin = segment.end;
    }
    return segments.back().place;
  }
};

/// Into `way`, from `place` on; what is longer than `longest` may end there.
void find_way(const Body& body, const Interface& interface, glm::vec3 place, glm::vec3 direction, float longest,
              Random& random, WayBack& way);

}  // namespace mesograin::transport

// What a change of a few grains' places leaves as it was: the rays that meet none of them, where they were or are.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "heap/grains.h"

namespace mesograin::heap {

class Moves {
 public:
  /// Nothing where none has moved, the number of grains, their kinds or the walls have changed, or so many have moved
  /// that next to nothing is left as it was.
  static std::optional<Moves> between(const Grains& before, const Grains& now);

  bool moved(std::size_t grain) const { return moved_[grain]; }

  /// How far along a ray a grain was or is that has moved; nothing where there is none.
  std::optional<float> distance(const glm::vec3& origin, const glm::vec3& direction) const;

 private:
  Moves(std::vector<bool> moved, const Grains& places);

  std::vector<bool> moved_;
  glm::vec3 middle_;  // of a ball around all places
  float reach_;
  Neighbourhood places_;
};

}  // namespace mesograin::heap

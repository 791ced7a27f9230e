// Takes noise out of light that few rays a pixel have found: a pixel's neighbours on the same object that face as it
// does have found nearly the same.
#pragma once

#include <cstdint>
#include <glm/vec4.hpp>
#include <vector>

#include "render/cast_shadows.h"
#include "render/go_on.h"

namespace mesograin::render {

class Denoiser {
 public:
  /// Puts means over neighbours in place of each pixel of a sample's `pictures` whose `looked_at` has a fourth number
  /// other than 0, where surfaces are `seen`. The later the sample, `index`, the nearer they must be: what the mean of
  /// all samples is blurred by vanishes as its noise does. What the pictures add up to at each pixel, if that is the
  /// same everywhere, stays so. False if ended.
  bool run(const SeenSurfaces& seen, std::uint32_t index, const std::vector<glm::vec4>& looked_at,
           const std::vector<std::vector<glm::vec4>*>& pictures, const GoOn& go_on);

 private:
  std::vector<std::vector<glm::vec4>> across_;
  std::vector<glm::vec4> guides_;
};

}  // namespace mesograin::render

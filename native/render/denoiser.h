// Takes noise out of light that few rays a pixel have found: a pixel's neighbours on the same object, where it is much
// alike, have found nearly the same.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "render/go_on.h"

namespace mesograin::render {

/// What tells pixels apart, without noise.
struct Likeness {
  glm::vec3 direction{0.0F};  ///< unit length
  float object = 0.0F;        ///< 0: nothing to filter
  float least_alike = 1.0F;   ///< a cosine between two directions, at which pixels tell each other nothing
  glm::vec3 share{1.0F};      ///< above 0: what light is alike in proportion to
};

class Denoiser {
 public:
  /// Puts means over neighbours in place of each pixel of a sample's `pictures` of this `size`. The later the sample,
  /// `index`, the nearer they must be: what the mean of all samples is blurred by vanishes as its noise does. All light
  /// is kept, and so is what the pictures add up to at each pixel, if it is the same everywhere. `deviation`: in
  /// pixels, of the first sample's Gaussian. False if ended.
  bool run(const glm::ivec2& size, std::uint32_t index, const std::vector<Likeness>& likenesses,
           const std::vector<std::vector<glm::vec4>*>& pictures, double deviation, const GoOn& go_on);

 private:
  std::vector<std::vector<glm::vec4>> relative_;
};

}  // namespace mesograin::render

// What surfaces of facets mirror of other objects, and others show straight through them, found by a ray from each
// pixel along the direction that it drew.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec4.hpp>
#include <vector>

#include "render/cast_content.h"
#include "render/cast_shadows.h"
#include "render/content.h"
#include "render/exchange.h"
#include "render/go_on.h"
#include "render/hit_surface.h"
#include "render/lighting.h"

namespace mesograin::render {

class CastMirrors {
 public:
  /// The faces of an area light send what the light does, and nothing here. `looks`: along which each pixel's mirror
  /// looks, xyz of unit length, w 0 where there is none. `layer`: how many times that was asked before of this sample,
  /// each time of what had been found. False if ended.
  bool cast(const CastContent& cast, const Content& content, const Exchange& exchange, const Lighting& lighting,
            const SeenSurfaces& seen, const std::vector<glm::vec4>& looks, std::size_t layer, const GoOn& go_on);

  /// What the rays met, nothing where they met the world. What stands in the world's way and is not to be shaded has a
  /// normal and no mark. Kept for one layer more.
  FoundSurfaces& found() { return found_[layer_ % 2]; }

 private:
  static constexpr std::uint32_t crossed_none = ~0U;

  std::array<FoundSurfaces, 2> found_;
  std::vector<std::vector<std::uint32_t>> crossed_;  // of each layer and pixel, what it goes on straight through
  std::size_t layer_ = 0;
};

}  // namespace mesograin::render

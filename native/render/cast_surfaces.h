// What the camera sees of instances, found by rays: the same that surface.frag draws, of the meshes in full.
#pragma once

#include <cstddef>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "render/cast_content.h"
#include "render/content.h"
#include "render/go_on.h"
#include "render/hit_surface.h"
#include "render/pixel_rays.h"

namespace mesograin::render {

class CastSurfaces {
 public:
  /// Casts a ray through each pixel. False if ended.
  bool cast(const CastContent& cast, const Content& content, const glm::dmat4& anchor_to_clip, const glm::vec2& jitter,
            const glm::ivec2& size, const GoOn& go_on);

  /// How many instances were seen.
  std::size_t seen() const;

  FoundSurfaces& found() { return found_; }

 private:
  void cast_band(const CastContent& cast, const Content& content, const glm::mat4& to_clip, const PixelRays& rays,
                 int first_row, int end_row);

  glm::ivec2 size_{0};
  FoundSurfaces found_;
};

}  // namespace mesograin::render

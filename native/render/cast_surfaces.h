// What the camera sees of instances, found by rays: the same that surface.frag draws, of the meshes in full.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "gl/texture.h"
#include "render/cast_content.h"
#include "render/content.h"
#include "render/go_on.h"
#include "render/pixel_rays.h"

namespace mesograin::render {

class CastSurfaces {
 public:
  /// Casts a ray through each pixel. False if ended.
  bool cast(const CastContent& cast, const Content& content, const glm::dmat4& anchor_to_clip, const glm::vec2& jitter,
            const glm::ivec2& size, const GoOn& go_on);

  /// Makes them the surfaces drawn so far. Groups mark the stencil from 1 for `first` up to the last it can hold.
  void upload(gl::Texture& position, gl::Texture& normal, gl::Texture& depth, std::size_t first);

  /// Makes them where on their pictures the surfaces drawn so far are.
  void upload_coordinates(gl::Texture& coordinates) { coordinates.upload(GL_RGBA, GL_FLOAT, coordinates_.data()); }

  /// How many instances were seen.
  std::size_t seen() const;

  /// As surface.frag writes them.
  const std::vector<glm::vec4>& positions() const { return positions_; }
  const std::vector<glm::vec4>& normals() const { return normals_; }

 private:
  // As GL_FLOAT_32_UNSIGNED_INT_24_8_REV.
  struct Depth {
    float depth;
    std::uint32_t stencil;
  };

  void cast_band(const CastContent& cast, const Content& content, const glm::mat4& to_clip, const PixelRays& rays,
                 int first_row, int end_row);

  glm::ivec2 size_{0};
  std::vector<glm::vec4> positions_;
  std::vector<glm::vec4> normals_;
  std::vector<glm::vec4> coordinates_;  // empty if nothing wears pictures
  std::vector<Depth> depths_;
  std::vector<std::uint32_t> groups_;  // from 1
};

}  // namespace mesograin::render

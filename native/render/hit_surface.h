// What rays find of surfaces, as surface.frag draws it: of the meshes in full.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "render/cast_content.h"
#include "render/content.h"
#include "render/passes/targets.h"

namespace mesograin::render {

struct HitSurface {
  static constexpr std::size_t unshaded = static_cast<std::size_t>(-1);

  glm::vec4 position;  ///< as surface.frag writes it, and so on
  glm::vec4 normal;
  glm::vec4 coordinates;  ///< of a material that wears pictures
  glm::vec3 origin;       ///< of grain space, from the anchor
  std::size_t unit;       ///< what is shaded apart: the groups of instances, then the draws; or unshaded
  bool flat;              ///< its triangle's normals are one
};

/// Where a ray that met something did.
HitSurface hit_surface(const CastContent& cast, const Content& content, const glm::vec3& direction,
                       const casting::Hit& hit);
HitSurface hit_surface(const CastContent& cast, const Content& content, const casting::Packet& packet,
                       const casting::Hits& hits, unsigned ray);

/// A rectangle of pixels; none if its end is its first.
struct PixelBox {
  glm::ivec2 first{0};
  glm::ivec2 end{0};
};

/// One for each pixel of a picture.
class FoundSurfaces {
 public:
  void resize(const glm::ivec2& size, bool textured);

  /// `depth` as the device has it.
  void put(std::size_t pixel, const HitSurface& surface, float depth);
  void put_nothing(std::size_t pixel);

  /// Makes them the surfaces drawn so far. Units mark the stencil from 1 for `first` up to the last it can hold.
  void upload(Targets& targets, std::size_t first);

  const std::vector<glm::vec4>& positions() const { return positions_; }
  const std::vector<glm::vec4>& normals() const { return normals_; }

  /// Around the pixels of each unit, of which there are `units`; empty if there are none at all.
  std::vector<PixelBox> boxes(const glm::ivec2& size, std::size_t units) const;

 private:
  // As GL_FLOAT_32_UNSIGNED_INT_24_8_REV.
  struct Depth {
    float depth;
    std::uint32_t stencil;
  };

  std::vector<glm::vec4> positions_;
  std::vector<glm::vec4> normals_;
  std::vector<glm::vec4> coordinates_;  // empty if nothing wears pictures
  std::vector<Depth> depths_;
  std::vector<std::size_t> marks_;  // the unit, from 1; 0 for nothing that is to be shaded
};

}  // namespace mesograin::render

// How it is found what is seen of arrays and what of them stands in the light: drawn, or cast.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <string_view>

#include "render/cast_content.h"
#include "render/passes/sample.h"
#include "render/surfaces.h"

namespace mesograin::render {

enum class Visibility {
  automatic,  ///< drawn where there is a GPU, else cast
  drawn,      ///< by the device's rasteriser
  cast,       ///< by rays, on all cores
};

inline constexpr std::array<std::string_view, 3> visibility_names = {"automatic", "drawn", "cast"};

class ArrayVisibility {
 public:
  /// Throws Error where rays are asked for and cannot be cast.
  void set(Visibility visibility);

  /// Whether rays are cast for this content.
  bool casts(const Content& content) const;

  /// Whether rays can be followed through all of it: a tree of arrays that the device draws is not worth its memory.
  bool traces(const Content& content) const;

  /// What surfaces of facets can do to find what they mirror, of those units whose models are asked. `world`: there is
  /// one to be mirrored. `behind`: what stands behind others is looked for, too.
  Mirrors mirrors(const Content& content, bool world, bool behind,
                  const std::function<bool(std::size_t unit)>& asks) const;

  /// Makes ready what the passes of this sample need of the arrays.
  void prepare(const Sample& sample);

  /// For a sample that casts rays.
  const CastContent& tree() const { return *tree_; }

  /// What the camera may see; null without arrays, or where rays find it and no light map must know how near it is.
  const DeviceSelection* selection() const { return selection_.get(); }

  void forget_content();
  void forget_view() { selection_.reset(); }

 private:
  Visibility visibility_ = Visibility::automatic;
  std::unique_ptr<CastContent> tree_;
  std::unique_ptr<DeviceSelection> selection_;
};

}  // namespace mesograin::render

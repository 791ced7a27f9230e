// How it is found what is seen of arrays and what of them stands in the light: drawn, or cast.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <string_view>

#include "render/cast_content.h"
#include "render/device_rays.h"
#include "render/passes/sample.h"
#include "render/surfaces.h"

namespace mesograin::render {

enum class Visibility {
  automatic,    ///< by rays: the device's where there is a GPU, else cast; drawn where they cannot be
  drawn,        ///< by the device's rasteriser
  cast,         ///< by rays, on all cores
  device_rays,  ///< by rays that the device follows
};

inline constexpr std::array<std::string_view, 4> visibility_names = {"automatic", "drawn", "cast", "device_rays"};

class ArrayVisibility {
 public:
  /// Throws Error where rays are asked for and cannot be cast.
  void set(Visibility visibility);

  /// Whether rays are cast for this content, on all cores.
  bool casts(const Content& content) const;

  /// Whether the device casts them.
  bool casts_on_device(const Content& content) const;

  /// Whether rays can be followed through all of it on this side: a tree of arrays that the device draws is not worth
  /// its memory, and where the device follows rays itself, none is made for a sample in a hurry.
  bool traces(const Content& content, bool hurried) const;

  /// What surfaces of facets can do to find what they mirror, of those units whose models are asked. `traced`: as
  /// traces(). `world`: there is one to be mirrored. `behind`: what stands behind others is looked for, too.
  Mirrors mirrors(const Content& content, bool traced, bool world, bool behind,
                  const std::function<bool(std::size_t unit)>& asks) const;

  /// Makes ready what the passes of this sample need of the arrays.
  void prepare(const Sample& sample);

  /// For a sample that casts rays.
  const CastContent& tree() const { return *tree_; }

  /// For a sample that has the device's.
  const DeviceRays& device_rays() const { return *device_rays_; }

  /// What the camera may see; null without arrays, or where rays find it and no light map must know how near it is.
  const DeviceSelection* selection() const { return selection_.get(); }

  void forget_content();
  void forget_view() { selection_.reset(); }

 private:
  Visibility visibility_ = Visibility::automatic;
  std::unique_ptr<CastContent> tree_;
  std::unique_ptr<DeviceRays> device_rays_;
  std::unique_ptr<DeviceSelection> selection_;
};

}  // namespace mesograin::render

// Finds what the camera sees, so that each pixel is shaded once: drawn, or where rays are cast for arrays, by rays and
// drawn in front of them.
#pragma once

#include <cstddef>
#include <vector>

#include "render/cast_shadows.h"
#include "render/cast_surfaces.h"
#include "render/device_casting.h"
#include "render/passes/array_visibility.h"
#include "render/passes/sample.h"

namespace mesograin::render {

class SurfacePass {
 public:
  /// What is shaded apart, the groups of instances and then the draws, marks the stencil: 1 for `first`, and so on up
  /// to the last it can hold. False if ended.
  bool run(const Sample& sample, const ArrayVisibility& arrays, std::size_t first);

  /// What was found, on this side of the device.
  SeenSurfaces seen(const Sample& sample);

  /// Of a sample that has the device's rays.
  const DeviceSurfaces& of_device() const { return device_; }

  /// How many instances rays met.
  std::size_t instances_seen() const { return cast_.seen(); }

  /// That the last run took of this side, of a sample that is cast.
  double milliseconds() const { return milliseconds_; }

 private:
  CastSurfaces cast_;
  DeviceSurfaces device_;
  std::vector<glm::vec4> read_positions_;
  std::vector<glm::vec4> read_normals_;
  double milliseconds_ = 0.0;
};

/// What rays through the pixels' middles meet, as View::read_surfaces.
void read_surfaces(const Sample& sample, float* positions, float* normals);

}  // namespace mesograin::render

// A kernel as the GPU takes it: values over distance, and the distances to sample it at.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "physics/body/body_medium.h"
#include "physics/kernels/surface_kernel.h"
#include "physics/table.h"

namespace mesograin::physics {

struct KernelTables {
  /// Columns are distances s_j = shortest * (exp(j step) - 1); rows are cosines of entry outside, evenly from 0 to 1.
  /// RGB: the kernel times the transmittance at entry. Alpha: -log of the share of light that goes farther than s_j (of
  /// the mean over the channels).
  Table profile;
  /// Columns k are shares exp(-largest_depth (k/(n-1))^2) of the light that goes farther. x: the distance; y: the
  /// density to divide by, never rising with the distance: the mean of the largest kernels from there on, each over its
  /// integral over the plane.
  Table inverse;
  double shortest = 0.0;
  double step = 0.0;
  double largest_depth = 0.0;

  [[nodiscard]] double columns_per_octave() const { return std::log(2.0) / step; }
};

/// `kernels` for red, green and blue; `resolution` is the distance that must be told from none, all in grain radii.
/// Distances end at `largest`, beyond which nothing is worth sampling. `by_cosine`: the kernels depend on the cosine.
KernelTables kernel_tables(const std::array<const SurfaceKernel*, 3>& kernels, const BodySurface& surface,
                           double resolution, double largest, bool by_cosine);

}  // namespace mesograin::physics

// Masks by name: what a comparison leaves out, and how much that is.
#pragma once

#include "image/image.h"
#include "image/metrics.h"

namespace mesograin::image {

/// The pixels of `mask` inside the rectangle [left, right) x [top, bottom), row 0 at the top. Throws Error if the
/// rectangle does not lie in the mask.
Mask crop_mask(const Mask& mask, int left, int top, int right, int bottom);

/// The pixels of `mask` whose error is at most mean + `deviations` standard deviations of the masked errors; pixels
/// whose error is not finite stay, so that they are counted and not hidden.
Mask mean_deviation_mask(const ImageView& error, const Mask& mask, double deviations = 1.0);

/// The pixels of `mask` whose median over `median_size` x `median_size` masked neighbours is at most the threshold that
/// best parts the masked medians into two classes: N. Otsu, "A threshold selection method from gray-level histograms"
/// (1979). The threshold is found on the medians themselves; no histogram of 256 greys rounds them.
/// Throws Error if median_size is not positive.
Mask otsu_mask(const ImageView& error, const Mask& mask, int median_size = 4);

}  // namespace mesograin::image

// The margin of a baked texture, so that filtering and smaller mip levels do not mix its charts with what lies between.
#pragma once

#include "image/image.h"

namespace mesograin::image {

/// A texture whose charts reach `margin` texels farther. Pixels are (height, width, 4), premultiplied by the coverage
/// in the last channel. Texels that a chart covers in part become its full colour; then each empty texel takes the mean
/// of its covered neighbours among the eight around it, `margin` times over (Blender's margin of type EXTEND). With 0
/// it is the texture itself. Throws Error for other than 4 channels, or a margin outside [0, 32767].
Image extend_margin(const ImageView& texture, int margin);

}  // namespace mesograin::image

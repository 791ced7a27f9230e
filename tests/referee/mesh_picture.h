// What a camera sees of a mesh in sunlight: backward walks that gather the unscattered light of every cell they
// scatter in.
#pragma once

#include <functional>

#include "picture.h"

namespace mesograin::referee {

/// As `trace_picture`, of `setup.mesh`. Unlike there light that has left may come back; the view ray's own mirror
/// image of the grain in itself is not in it. Channels of one sigma_t share their walks.
Picture trace_mesh_picture(const PictureCase& setup, const std::function<void()>& row_done = {});

}  // namespace mesograin::referee

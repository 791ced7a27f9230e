// Rows of a picture that rays are cast for on all cores, until it is asked to stop.
#pragma once

#include <functional>

#include "render/go_on.h"

namespace mesograin::render {

/// Calls `work(first, end)` for bands of rows, side by side. False if ended before all were done.
bool cast_rows(int height, const GoOn& go_on, const std::function<void(int first, int end)>& work);

}  // namespace mesograin::render

// Which arrays of grains that refract are seen so small that numbers tell what has entered them, so that no model is
// asked, nor shadows where light enters.
#pragma once

#include <cstddef>
#include <vector>

#include "render/passes/sample.h"
#include "render/passes/surface_pass.h"

namespace mesograin::render {

/// For Sample::told.
std::vector<bool> told_units(const Sample& sample);

/// How many grains of such units the pixels show; where the device follows rays, how many there are.
std::size_t told_grains(const Sample& sample, SurfacePass& surfaces);

}  // namespace mesograin::render

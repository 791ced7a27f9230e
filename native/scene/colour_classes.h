// Grains of many colours as arrays of one material each, so that whatever is computed from a material is computed for a
// few of them.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace mesograin::scene {

/// Arrays without factors stay as they are, and come first. Of those of one material with factors come as many
/// materials as their instances need to be of a colour within 1 % of their own, but at most 32; of a model whose tables
/// depend on the grain's radius at most 16, and 64 with all sizes; 8 of one whose transport depends on the mesh. A
/// class has the mean of its members' factors, whatever array they are of, so that a heap's mean colour stays.
std::vector<InstanceArray> by_colour(const std::vector<InstanceArray>& arrays);

}  // namespace mesograin::scene

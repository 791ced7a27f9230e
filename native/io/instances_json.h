// Where the instances of an object of a scene in JSON stand: inline, or in a file beside it.
#pragma once

#include <filesystem>
#include <vector>

#include "io/json_node.h"
#include "scene/scene.h"

namespace mesograin::io {

/// Adds instances of `prototype` at every place that `node` names. Files are looked for in `folder`.
void read_instances(const Node& node, const scene::Instance& prototype, const std::filesystem::path& folder,
                    std::vector<scene::InstanceArray>& arrays);

/// 3 or 4 rows of 4 numbers.
glm::dmat4 read_transform(const Node& rows);

}  // namespace mesograin::io

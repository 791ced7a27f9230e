// The material of a scene in JSON: the schema's parameters by their names, and some of them in other words.
#pragma once

#include <optional>

#include "io/json_node.h"
#include "scene/material.h"

namespace mesograin::io {

/// `asked` answers the material, else the preferred model of its kind.
scene::Material read_material(const Node& node, const std::optional<scene::Model>& asked);

}  // namespace mesograin::io

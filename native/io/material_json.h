// The material of a scene in JSON: the schema's parameters by their names, and some of them in other words.
#pragma once

#include <filesystem>
#include <optional>

#include "io/json_node.h"
#include "scene/material.h"

namespace mesograin::io {

/// Whether a model is one of those that answer a material's `kind`. Throws Error for a kind that there is not.
bool answers_kind(const Node& kind, scene::Model model);

/// `asked` answers the material, else the preferred model of its kind. Files are looked for in `folder`.
scene::Material read_material(const Node& node, const std::optional<scene::Model>& asked,
                              const std::filesystem::path& folder);

}  // namespace mesograin::io

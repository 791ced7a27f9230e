// The lights and the world of a scene in JSON.
#pragma once

#include <filesystem>
#include <vector>

#include "io/json_node.h"
#include "scene/light.h"
#include "scene/world.h"

namespace mesograin::io {

/// The scene's `lights`; none where there is a `world`.
std::vector<scene::Light> read_lights(const Node& root);

/// As read_lights takes it.
Json to_json(const scene::Light& light);

/// Its image is looked for in `folder`.
scene::World read_world(const Node& node, const std::filesystem::path& folder);

}  // namespace mesograin::io

// A surface's finish in a scene in JSON: pictures are EXR files beside it.
#pragma once

#include <filesystem>
#include <string>

#include "io/json_node.h"
#include "scene/finish.h"

namespace mesograin::io {

scene::Finish read_finish(const Node& node, const std::filesystem::path& folder);

/// As read_finish takes it. Its pictures are written to `folder`, in files whose names begin with `prefix`.
Json written_finish(const scene::Finish& finish, const std::filesystem::path& folder, const std::string& prefix);

}  // namespace mesograin::io

// What an EXR's header tells of how its picture was made, so that it can be made again.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "gl/egl_context.h"
#include "io/scene_json.h"

namespace mesograin::tool {

std::map<std::string, std::string> provenance(const io::SceneFile& file, int samples, std::uint32_t seed,
                                              const gl::DeviceInfo& device);

/// The models that answer its materials, each once.
std::string model_names(const scene::Scene& scene);

/// What a baked texture's header says besides.
std::map<std::string, std::string> bake_provenance(const std::string& view_from, int margin);

}  // namespace mesograin::tool

// The shader text that was embedded at build time, by path relative to shaders/.
#pragma once

#include <string_view>
#include <vector>

namespace mesograin::gl {

struct ShaderFile {
  std::string_view path;  ///< "physics/fresnel.glsl"
  std::string_view text;
};

/// Every file below shaders/, sorted by path.
const std::vector<ShaderFile>& shader_files();

}  // namespace mesograin::gl

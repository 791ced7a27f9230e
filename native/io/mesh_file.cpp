// Chooses the reader by the file's ending and puts the file's name in front of what is wrong with it.
#include "io/mesh_file.h"

#include <algorithm>
#include <cctype>
#include <new>
#include <string>

#include "base/error.h"
#include "base/file.h"

namespace mesograin::io {

scene::Mesh read_mesh(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  if (ending != ".obj" && ending != ".ply")
    throw Error("Can't read {}: a mesh must be an .obj or .ply file.", path.string());
  const std::string bytes = base::read_file(path);
  try {
    return ending == ".obj" ? parse_obj(bytes) : parse_ply(bytes);
  } catch (const Error& error) {
    throw Error("Can't read {}: {}", path.string(), error.what());
  } catch (const std::bad_alloc&) {
    throw Error("Can't read {}: there is not enough memory for it.", path.string());
  }
}

}  // namespace mesograin::io

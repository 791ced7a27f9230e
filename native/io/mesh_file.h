// Meshes from OBJ and PLY files, polygons cut into triangles and missing normals smoothed.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "scene/mesh.h"

namespace mesograin::io {

/// Reads .obj, and .ply in ASCII or little-endian binary; materials, groups, lines and points are left out. Normals
/// that are missing are smooth over all faces that share a position, weighted by their areas. UVs are kept if every
/// corner has them.
/// Throws Error, with the line or byte where that says more, if the file is missing, damaged, or holds no triangle.
scene::Mesh read_mesh(const std::filesystem::path& path);

/// The same from the file's text or bytes.
scene::Mesh parse_obj(std::string_view text);
scene::Mesh parse_ply(std::string_view bytes);

/// A mesh as binary PLY, from which parse_ply makes the same vertices.
std::string to_ply(const scene::Mesh& mesh);

}  // namespace mesograin::io

// A mesh of many grains, as an array of them, a pile that was joined or a scan comes as: each closed surface is a body
// of its own, and those that are copies of each other are placings of one.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <span>
#include <vector>

#include "scene/mesh.h"

namespace mesograin::scene {

struct Bodies {
  MeshPointer mesh;
  std::vector<glm::dmat4> placings;  ///< to the whole mesh's space: turned, moved and scaled evenly
};

/// The bodies of a mesh, their surfaces facing outwards; none if it has fewer than two closed ones, unless all of it is
/// one that is inside out. A closed surface within another belongs to it if it
/// is a cavity of it, or a grain in no cavity; all that is open is one body, the last.
/// vertices: for each of the mesh's positions the number of its vertex; surfaces that touch share none. Where some of
/// the mesh is open by these, positions that coincide are one vertex, too. copies: whether what is a copy of another,
/// vertex by vertex and within 1e-4 of its size, becomes a placing of it; else each has a mesh in its own place.
/// Throws Error if there are not as many vertices as positions.
std::vector<Bodies> bodies_of(const Mesh& mesh, std::span<const std::uint32_t> vertices, bool copies);

}  // namespace mesograin::scene

// Cuts polygons into triangles, as mesh files and modelling programs hold any number of corners.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace mesograin::io {

/// Readers refuse faces of more corners, whose cutting could take minutes.
inline constexpr std::size_t most_corners = 4096;

/// Corner numbers (0 to corners - 1) of the triangles that fill a polygon, in its own winding; corners - 2 of them.
/// A concave polygon is cut by its ears, a polygon that crosses itself still gives corners - 2 triangles.
/// Needs at least 3 corners.
std::vector<glm::uvec3> triangulate(std::span<const glm::vec3> corners);

}  // namespace mesograin::io

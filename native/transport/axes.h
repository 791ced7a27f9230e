// Axes along which a body fits tightly into a box, so that its nodes are where it is.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace mesograin::transport {

/// A turn whose box around `positions` is the smallest of those tried: none, along the principal axes of the
/// surface, and along pairs of its largest faces. `normals` are as long as the triangles' areas.
glm::dmat3 tight_axes(const std::vector<glm::dvec3>& positions, const std::vector<glm::dvec3>& normals,
                      const std::vector<glm::uvec3>& triangles);

}  // namespace mesograin::transport

// Which model serves a grain of some size, shape and medium: the cheapest that was measured to be near enough.
#pragma once

#include <glm/mat3x3.hpp>
#include <string>

#include "scene/auto.h"
#include "scene/material.h"
#include "scene/mesh.h"

namespace mesograin::scene {

/// What of a grain's shape decides, in one unit of length.
struct Shape {
  double volume;
  double area;
  bool closed;  ///< each edge has two triangles, or an even number of them
};

/// Of a mesh that is drawn through the linear part of its transform.
Shape shape_of(const Mesh& mesh, const glm::dmat3& to_world);

struct Advice {
  Model model;
  double error;          ///< measured, in %
  std::string sentence;  ///< why
};

/// For a grain of this medium, whatever its model. Lengths are those that sigma_a and sigma_s are per. What encloses no
/// volume, or neither scatters nor absorbs, is given the preferred translucent model. tolerance: in %; where no model
/// was measured to be as near, it is the nearest.
Advice advise(const Material& material, const Shape& shape, double tolerance = automatic::tolerance);

}  // namespace mesograin::scene

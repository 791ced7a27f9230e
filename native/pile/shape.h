// What a grain is to others: balls inside it that touch its surface from within, and how far a place is from it.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "pile/field.h"
#include "pile/support.h"
#include "pile/triangles.h"

namespace mesograin::pile {

struct Ball {
  glm::vec3 middle;
  float radius;
};

struct Shape {
  std::vector<Ball> balls;
  std::vector<Field> field;  ///< one; none: the grain is a ball
  Support support{1.0};
  glm::dmat3 inertia{0.4};  ///< of mass 1, about the centre of mass
  glm::dmat3 axes{1.0};     ///< columns: along the longest, the middle and the shortest extent
  glm::dvec3 half{1.0};     ///< how far it reaches along these
  double reach = 1.0;       ///< from its middle
  double thickness = 1.0;   ///< radius of the largest ball in it
};

Shape ball_shape(double radius);

/// Of a closed mesh about as large as the unit sphere, its centre of mass at the origin. Throws Error if it has no
/// triangle.
Shape shape_of(const Mesh& mesh);

}  // namespace mesograin::pile

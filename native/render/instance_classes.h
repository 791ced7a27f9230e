// Which instances of an array share their material's tables: those of about one size, and, where a model depends on the
// mesh, of about one stretch.
#pragma once

#include <cstddef>
#include <glm/mat3x3.hpp>
#include <vector>

#include "scene/scene.h"

namespace mesograin::render {

struct InstanceClass {
  double typical_scale = 1.0;  ///< of the instance that the tables are for: the cube root of how its volume grows
  glm::dmat3 stretch{1.0};     ///< of that instance; what it does to the mesh beside a turn
  std::vector<std::size_t> members;
};

/// All instances, each in one class.
std::vector<InstanceClass> instance_classes(const scene::InstanceArray& array);

}  // namespace mesograin::render

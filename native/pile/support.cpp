// The farthest vertex along each of some vectors.
#include "pile/support.h"

#include <glm/geometric.hpp>

namespace mesograin::pile {

Support::Support(const std::vector<glm::dvec3>& vertices) : nodes_(number(6, 0, 0)) {
  for (int side = 0; side < 6; ++side)
    for (int j = 0; j < nodes_along; ++j)
      for (int i = 0; i < nodes_along; ++i) {
        const int axis = side / 2;
        glm::dvec3 along;
        along[axis] = side % 2 == 0 ? 1.0 : -1.0;
        along[(axis + 1) % 3] = 2.0 * i / cells - 1.0;
        along[(axis + 2) % 3] = 2.0 * j / cells - 1.0;
        double farthest = 0.0;
        for (const glm::dvec3& vertex : vertices) farthest = std::max(farthest, glm::dot(vertex, along));
        nodes_[number(side, i, j)] = static_cast<float>(farthest);
      }
}

}  // namespace mesograin::pile

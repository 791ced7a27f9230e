// Grains that fall, knock and rub against each other until they rest: where those of a pile lie and how they are
// turned.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "pile/ground.h"

namespace mesograin::pile {

/// `radii`: how large each is, over its mesh. `shapes`: which of `meshes` each has; without meshes they are balls. A
/// mesh is closed, about as large as the unit sphere, its centre of mass at the origin.
struct Grains {
  std::vector<double> radii;
  std::vector<std::uint32_t> shapes;
  std::vector<Mesh> meshes;
};

/// `numbers`: which of the grains lie there, in their order; all but where no more fit inside a mesh.
struct Pile {
  std::vector<std::uint32_t> numbers;
  std::vector<glm::dvec3> middles;
  std::vector<glm::dquat> turns;
  double largest_overlap = 0.0;  ///< of two grains, in radii of the smaller one
};

/// Called now and then with how far it is, 0 to 1; false ends it.
using Progress = std::function<bool(double)>;

/// Lets the grains fall on the ground, z up, between the walls. The same `seed` gives the same pile.
/// Inside a mesh walls are not asked for, and no more grains come than fit.
/// `friction`: the coefficient of Coulomb's law, between grains and on the ground. Throws Error if there is no grain, a
/// radius is not greater than 0, the walls or a mesh that they shall lie inside leave no room, or it was ended.
Pile settle(const Grains& grains, const Ground& ground, const Walls& walls, double friction, std::uint64_t seed,
            const Progress& progress);

}  // namespace mesograin::pile

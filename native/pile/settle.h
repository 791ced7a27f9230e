// Balls that fall, knock and rub against each other until they rest: where the grains of a pile lie.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <vector>

#include "pile/ground.h"

namespace mesograin::pile {

struct Pile {
  std::vector<glm::dvec3> middles;
  double largest_overlap = 0.0;  ///< of two balls, in radii of the smaller one
};

/// Called now and then with how far it is, 0 to 1; false ends it.
using Progress = std::function<bool(double)>;

/// Lets balls of these radii fall on the ground, z up, between the walls. The same `seed` gives the same pile.
/// `friction`: the coefficient of Coulomb's law, between balls and on the ground. Throws Error if there is no ball, a
/// radius is not greater than 0, the walls leave no room, or it was ended.
Pile settle(const std::vector<double>& radii, const Ground& ground, const Walls& walls, double friction,
            std::uint64_t seed, const Progress& progress);

}  // namespace mesograin::pile

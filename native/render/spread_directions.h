// Directions in all of space for light that comes evenly from everywhere: however few, they do for what faces any way.
#pragma once

#include <cstdint>
#include <glm/ext/quaternion_double.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace mesograin::render {

/// An endless row for each seed. Each four from a multiple of four on are the corners of a regular tetrahedron, a
/// spherical 2-design (Delsarte, Goethals and Seidel, "Spherical codes and designs", 1977): what is of order 2 at most
/// has the right mean over them, and the irradiance of a plane is 7.5 % off in the mean of all normals.
/// Of some that are tried each is the one whose corners are farthest in all from those before it: the sum of distances
/// is the greater, the nearer each cap of the sphere holds as many as it should (Stolarsky, "Sums of distances between
/// points on a sphere", 1973). And level ground, of which pictures show most, has its irradiance.
class SpreadDirections {
 public:
  /// Of unit length.
  glm::dvec3 at(std::uint32_t index, std::uint32_t seed);

 private:
  void begin(std::uint32_t run, std::uint32_t seed);
  void add_tetrahedron();

  std::uint32_t seed_ = 0;
  std::uint32_t run_ = 0;  // of the row: each is spread out in itself, and no other lies as it does
  glm::dquat turn_{};
  std::vector<glm::dvec3> directions_;
  double irradiance_ = 0.0;  // of level ground, by these, beyond what it should be
};

}  // namespace mesograin::render

// Balls in the cells of a grid, and what a ray meets of them.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

namespace mesograin::referee {

struct Ball {
  glm::dvec3 middle;
  double radius;
};

class BallGrid {
 public:
  explicit BallGrid(std::vector<Ball> balls);

  const Ball& ball(std::uint32_t number) const { return balls_[number]; }

  struct Hit {
    std::uint32_t number;
    double distance;
  };

  /// The first ball that a ray enters from outside; `direction` has unit length.
  std::optional<Hit> first(const glm::dvec3& origin, const glm::dvec3& direction) const;

  /// How much of a ray lies in balls, those that it starts in included but for `without`.
  double way_in_balls(const glm::dvec3& origin, const glm::dvec3& direction, std::uint32_t without) const;

 private:
  template <class Visit>
  void visit(const glm::dvec3& origin, const glm::dvec3& direction, const Visit& visit) const;

  std::size_t number_of(const glm::ivec3& cell) const;

  std::vector<Ball> balls_;
  glm::dvec3 lower_;
  double size_ = 1;  // of a cell
  glm::ivec3 cells_;
  std::vector<std::uint32_t> begins_;
  std::vector<std::uint32_t> numbers_;
};

}  // namespace mesograin::referee

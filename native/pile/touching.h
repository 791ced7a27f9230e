// Where grains touch each other and what holds them: which balls may meet what, and where they do now.
#pragma once

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "pile/contacts.h"
#include "pile/start.h"

namespace mesograin::pile {

inline constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max();

/// A ball of grain `a` may meet another grain, a triangle or a plane. What was found out of it is kept for the next
/// step.
struct Meeting {
  std::uint32_t a = 0;
  std::uint32_t b = nobody;         ///< the other grain
  std::uint32_t triangle = nobody;  ///< without either, it is a plane
  std::uint32_t ball = 0;
  double from_origin = 0.0;  ///< of the plane
  glm::dvec3 normal{0.0};    ///< towards a
  double gap = 0.0;          ///< less than 0 where they overlap
  glm::dvec3 place{0.0};     ///< where a's ball is nearest
  double push = 0.0;         ///< along the normal, in the last step
  glm::dvec3 rub{0.0};       ///< across it
};

/// What a grain counted on when it looked for others.
struct Outlook {
  glm::dvec3 way{0.0};  ///< in a step
  glm::dvec3 strayed{0.0};
  double slack = 0.0;   ///< how far it may stray
  int steps = 0;        ///< that it is good for
  int steps_known = 0;  ///< of these, that are left
  bool old = true;
};

class Touching {
 public:
  Touching(const std::vector<Grain>& grains, const Triangles& surface, double floor, const Walls& walls)
      : grains_(grains), surface_(surface), floor_(floor), walls_(walls) {}

  /// Looks anew for what grains may meet whose outlooks are old, pushes of those known before are kept.
  void look(const std::vector<Outlook>& outlooks);

  /// How many balls of a grain are asked for from the next look on, by another grain and by the ground; the first of a
  /// shape's are those that tell most.
  void set_detail(std::size_t by_grains, std::size_t by_ground) {
    by_grains_ = by_grains;
    by_ground_ = by_ground;
  }

  /// Measures gaps, normals and places anew.
  void measure();

  std::vector<Meeting>& meetings() { return meetings_; }
  const std::vector<Meeting>& meetings() const { return meetings_; }

  /// How each grain is turned, as a matrix; of when this measured or looked last.
  const std::vector<glm::dmat3>& turns() const { return turns_; }

  /// Whether grain `a`, which moves so, would pass through a triangle.
  bool passes(std::uint32_t a, const glm::dvec3& moved) const;

 private:
  void turn();
  void recall(std::size_t first);
  void measure(Meeting& meeting) const;
  void of_pair(std::uint32_t a, std::uint32_t b, double range, std::vector<Meeting>& found) const;
  void of_ground(std::uint32_t a, double range, std::vector<Meeting>& found);

  const std::vector<Grain>& grains_;
  const Triangles& surface_;
  double floor_;
  const Walls& walls_;
  std::vector<glm::dmat3> turns_;
  std::size_t by_grains_ = std::numeric_limits<std::size_t>::max();
  std::size_t by_ground_ = by_grains_;
  std::vector<Ball> balls_;  // of all grains, where they are
  std::vector<std::size_t> first_ball_;
  std::vector<Meeting> meetings_;
  std::vector<Meeting> known_;
  std::vector<std::vector<std::uint32_t>> triangles_of_;
};

}  // namespace mesograin::pile

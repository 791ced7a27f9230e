// Where grains touch each other and what holds them: which balls may meet what, and where they do now.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

#include "pile/start.h"

namespace mesograin::pile {

inline constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max();

/// A ball of grain `a` may meet another grain, a triangle or a plane. What was found out of it is kept for the next
/// step.
struct Meeting {
  std::uint32_t a = 0;
  std::uint32_t b = nobody;     ///< the other grain
  std::uint32_t side = nobody;  ///< without one: which triangle, or, beyond these, which plane
  std::uint32_t ball = 0;
  float gap = 0.0F;        ///< less than 0 where they overlap
  float gone = 0.0F;       ///< how far both grains together had gone when it was measured
  glm::vec3 normal{0.0F};  ///< towards a
  glm::vec3 arm{0.0F};     ///< from a's middle to where its ball is nearest
  float push = 0.0F;       ///< along the normal, in the last step
  glm::vec3 rub{0.0F};     ///< across it
};

inline constexpr int most_ahead = 8;  ///< steps, for which a grain that moves looks for others

/// What a grain counted on when it looked for others.
struct Outlook {
  glm::dvec3 way{0.0};  ///< in a step
  glm::dvec3 strayed{0.0};
  double turned = 0.0;  ///< how far any of its places has gone about its middle
  double slack = 0.0;   ///< how far it may stray and turn
  int steps = 0;        ///< that it is good for
  int steps_known = 0;  ///< of these, that are left
  bool old = true;
};

/// Who are farther apart than this cannot touch within a step in which they may go so far, and so little is missed: one
/// of two that meet has mostly been stopped.
inline float near_in_step(float speed_a, float speed_b) { return std::max(speed_a, speed_b) + 0.02F; }

class Touching {
 public:
  Touching(const std::vector<Grain>& grains, const Triangles& surface, double floor, const Walls& walls);

  /// Looks anew for what grains may meet whose outlooks are old, pushes of those known before are kept. What they may
  /// meet already is measured anew.
  void look(const std::vector<Outlook>& outlooks, std::span<const float> speeds);

  /// How many balls of a grain are asked for from the next look on, by another grain and by the ground; the first of a
  /// shape's are those that tell most.
  void set_detail(std::size_t by_grains, std::size_t by_ground) {
    by_grains_ = by_grains;
    by_ground_ = by_ground;
  }

  /// Measures gaps, normals and arms anew where grains may meet in a step in which each goes so far; other gaps stay
  /// as they are.
  void measure(std::span<const float> speeds);

  /// There are more grains than before.
  void grow() { gone_.resize(grains_.size()); }

  /// A grain went so far at most, any of its places.
  void went(std::uint32_t a, double far) { gone_[a] += far; }

  /// Those of a grain with another follow each other.
  std::vector<Meeting>& meetings() { return meetings_; }

  /// How each grain is turned, as a matrix; of when this measured or looked last.
  const std::vector<glm::mat3>& turns() const { return turns_; }

  /// Whether grain `a`, which moves so, would pass through a triangle.
  bool passes(std::uint32_t a, const glm::dvec3& moved) const;

 private:
  struct Plane {
    glm::dvec3 normal;
    double from_origin;
  };

  void turn();
  void recall(std::size_t first);
  void find(const std::vector<Outlook>& outlooks);
  void measure_first(std::size_t count, std::span<const float> speeds);
  void measure(Meeting& meeting) const;
  void measure_side(Meeting& meeting) const;
  bool apart(std::uint32_t a, std::uint32_t b, double range) const;
  void of_pair(std::uint32_t a, std::uint32_t b, double range, std::vector<Meeting>& found) const;
  void of_ground(std::uint32_t a, double range, std::vector<Meeting>& found);

  const std::vector<Grain>& grains_;
  const Triangles& surface_;
  std::vector<Plane> planes_;
  std::vector<double> gone_;
  std::vector<glm::mat3> turns_;
  std::size_t by_grains_ = std::numeric_limits<std::size_t>::max();
  std::size_t by_ground_ = by_grains_;
  std::vector<Meeting> meetings_;
  std::vector<Meeting> known_;
  std::vector<std::vector<Meeting>> found_;
  std::vector<std::vector<std::uint32_t>> triangles_of_;
};

}  // namespace mesograin::pile

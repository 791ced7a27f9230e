// What pushes of grains that touch do to their motion within a step.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "pile/touching.h"

namespace mesograin::pile {

/// Lengths are in mean radii, a grain of radius 1 is the unit of mass.
struct Body {
  glm::vec3 moved{0.0F};  ///< within a step
  glm::vec3 turned{0.0F};
  float lightness = 1.0F;  ///< 1 / mass
  bool touched = false;    ///< pushed by another or the ground, in the last step
  glm::mat3 ease{0.0F};    ///< of turning: the inverse inertia
};

/// A meeting within a step.
struct Contact {
  Meeting* meeting;
  std::uint32_t a, b;
  glm::vec3 normal;
  glm::vec3 arm_a, arm_b;
  glm::vec3 turning_a, turning_b;  ///< by a push of 1
  float least;                     ///< how far they may come nearer, less than 0; or must part
  float mass;                      ///< a push for a way
  glm::mat3 lightness;             ///< how the place moves by a push of 1
  float push;
  glm::vec3 rub;
};

/// Solves for the pushes. Grains are dealt into slices along x, so that contacts of one slice and those of another are
/// solved at the same time; the slices, and so what comes out, do not depend on how many threads there are.
class Solver {
 public:
  /// The slices of grains that are here.
  void slice(const std::vector<Grain>& grains);

  /// Takes the meetings that may matter when each grain goes as far as `speeds` has it.
  void take(const std::vector<Grain>& grains, std::span<Meeting> meetings, std::span<const float> speeds,
            const std::vector<Body>& bodies);

  /// Changes how bodies move; `friction` is that of Coulomb's law.
  void solve(std::vector<Body>& bodies, float friction);

  /// The deepest of all meetings taken.
  float overlap() const { return overlap_; }

 private:
  static constexpr std::size_t slices = 8;
  // Contacts within each slice; between it and the next; all others.
  static constexpr std::size_t lists = 2 * slices;
  using Lists = std::array<std::vector<Contact>, lists>;

  std::size_t list_of(const Contact& contact) const;
  void choose(std::span<Meeting> meetings, std::span<const float> speeds, const std::vector<Grain>& grains,
              const std::vector<Body>& bodies, Lists& found) const;
  void add(Meeting& meeting, const std::vector<Grain>& grains, const std::vector<Body>& bodies, Lists& found) const;
  template <typename Work>
  void on_all(const Work& work);

  std::vector<std::uint8_t> slice_of_;
  std::vector<double> places_;
  std::vector<Lists> parts_;
  std::vector<float> overlaps_;
  Lists contacts_;
  float overlap_ = 0.0F;
};

}  // namespace mesograin::pile

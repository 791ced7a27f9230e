// Evenly distributed places in a disc or a regular polygon.
#include "scene/lens.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "base/error.h"

namespace mesograin::scene {
namespace {

// Shirley and Chiu, "A Low Distortion Map Between Disk and Square", 1997: neighbours stay neighbours.
glm::dvec2 in_disc(const glm::dvec2& random) {
  const glm::dvec2 square = 2.0 * random - 1.0;
  if (square.x == 0.0 && square.y == 0.0) return square;
  const bool wide = std::abs(square.x) > std::abs(square.y);
  const double radius = wide ? square.x : square.y;
  const double eighth = glm::pi<double>() / 4.0;
  const double angle = wide ? eighth * (square.y / square.x) : 2.0 * eighth - eighth * (square.x / square.y);
  return radius * glm::dvec2(std::cos(angle), std::sin(angle));
}

// One of the triangles from the middle to a blade, and a place in it (Pharr, Jakob and Humphreys, "Physically Based
// Rendering", 3rd edition, 13.6.5). A blade's middle lies to the right.
glm::dvec2 in_polygon(int corners, double rotation, const glm::dvec2& random) {
  const double blade = std::min(std::floor(random.x * corners), corners - 1.0);
  const double root = std::sqrt(random.x * corners - blade);
  const double first = 1.0 - root;
  const double second = random.y * root;
  const double half = glm::pi<double>() / corners;
  const glm::dvec2 upright((first + second) * std::cos(half), (first - second) * std::sin(half));
  const double turn = rotation + 2.0 * half * blade;
  return {std::cos(turn) * upright.x - std::sin(turn) * upright.y,
          std::sin(turn) * upright.x + std::cos(turn) * upright.y};
}

}  // namespace

glm::dvec2 Lens::place(const glm::dvec2& random) const {
  const glm::dvec2 unit = blades < 3 ? in_disc(random) : in_polygon(blades, rotation, random);
  return aperture_radius * glm::dvec2(unit.x / ratio, unit.y);
}

void validate(const Lens& lens) {
  if (!(lens.aperture_radius >= 0.0 && std::isfinite(lens.aperture_radius)))
    throw Error("A lens needs an aperture_radius of at least 0; got {}.", lens.aperture_radius);
  if (!(lens.focus_distance > 0.0 && std::isfinite(lens.focus_distance)))
    throw Error("A lens needs a focus_distance above 0; got {}.", lens.focus_distance);
  if (lens.blades < 0) throw Error("A lens has no fewer than 0 blades; got {}.", lens.blades);
  if (!std::isfinite(lens.rotation)) throw Error("The rotation of a lens must be finite; got {}.", lens.rotation);
  if (!(lens.ratio > 0.0 && std::isfinite(lens.ratio)))
    throw Error("A lens needs a ratio above 0; got {}.", lens.ratio);
}

}  // namespace mesograin::scene

// Light that was scattered once: what integrals say of it below a wide face, and of suns of several points.
#include "transport/scattered_once.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "shapes.h"

namespace mesograin::transport {
namespace {

/// Of irradiance 1, from where `towards` says in the mesh's space.
Lamp sun_from(const glm::dvec3& towards) {
  Lamp sun{[towards](const glm::dvec3&, const glm::dvec2&) { return LampRay{glm::normalize(towards), 1.0, 1e30}; }, ""};
  sun.far = true;
  return sun;
}

/// The integral of E_1(|depth - t|) exp(-t) / 2 over t: light that falls straight down on a half-space, scattered once.
double once_below(double depth) {
  constexpr int steps = 20000;
  constexpr double deepest = 30.0;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double t = deepest * (i + 0.5) / steps;
    sum += -std::expint(-std::max(std::abs(depth - t), 1e-9)) * std::exp(-t);
  }
  return 0.5 * sum * deepest / steps;
}

TEST(ScatteredOnce, IsThatOfAHalfSpaceBelowAWideFace) {
  constexpr double thick = 8.0;  // mean free paths from the middle to a face
  const Body body(cube());
  const Grid grid(body, 6600, Spacing::even, 10500, {}, 0.2F);
  const double sigma_t = thick * body.unit();
  const Lights once = scattered_once(body, grid, {sigma_t}, sun_from({0.0, 0.0, 1.0}), {});
  double off = 0.0, all = 0.0, total = 0.0;
  for (std::size_t node = 0; node < grid.places().size(); ++node) {
    const glm::dvec3 place = body.unit() * (glm::dvec3(grid.places()[node]) * body.axes());
    if (std::max(std::abs(place.x), std::abs(place.y)) > 0.5 || place.z < 0.5) continue;
    const double right = once_below(thick * (1.0 - place.z)) / (4.0 * std::numbers::pi);
    const double found = once(static_cast<Eigen::Index>(node), 0);
    off += std::abs(found - right);
    total += found;
    all += right;
  }
  EXPECT_NEAR(total / all, 1.0, 0.01);
  EXPECT_LT(off / all, 0.05);  // the rays' noise
}

TEST(ScatteredOnce, OfAWideSunIsThatOfItsPoints) {
  const Body body(cube());
  const Grid grid(body, 600);
  const std::vector<double> extinctions = {2.0, 5.0};
  const glm::dvec3 one(0.3, 0.4, 1.0), other(0.3, -1.0, 0.2);
  Lamp both = sun_from(one);
  both.at = [one, other](const glm::dvec3&, const glm::dvec2& random) {
    return LampRay{glm::normalize(random.x < 0.5 ? one : other), 1.0, 1e30};
  };
  const Lights found = scattered_once(body, grid, extinctions, both, {});
  const Lights right = 0.5F * (scattered_once(body, grid, extinctions, sun_from(one), {}) +
                               scattered_once(body, grid, extinctions, sun_from(other), {}));
  ASSERT_EQ(found.cols(), 2);
  for (Eigen::Index column = 0; column < 2; ++column) {
    EXPECT_NEAR(found.col(column).sum() / right.col(column).sum(), 1.0, 0.01);
    EXPECT_LT((found - right).col(column).cwiseAbs().sum() / right.col(column).sum(), 0.1);
  }
}

TEST(ScatteredOnce, OfNoLightIsNone) {
  const Body body(cube());
  const Grid grid(body, 200);
  Lamp dark = sun_from({0.0, 0.0, 1.0});
  dark.at = [](const glm::dvec3&, const glm::dvec2&) { return LampRay{{0.0, 0.0, 1.0}, 0.0, 1e30}; };
  EXPECT_EQ(scattered_once(body, grid, {2.0}, dark, {}).cwiseAbs().maxCoeff(), 0.0F);
}

}  // namespace
}  // namespace mesograin::transport

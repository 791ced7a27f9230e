// Lamps beside a body: far away they are parallel light, and what nothing has scattered can be written down.
#include "transport/lamp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>

#include "shapes.h"
#include "transport/grid.h"
#include "transport/interface.h"
#include "transport/octahedron.h"
#include "transport/stored_transport.h"
#include "transport/unscattered.h"
#include "transport/walks.h"

namespace mesograin::transport {
namespace {

constexpr Quality many_rays{.nodes = 1500, .light_across = 24, .way_across = 10};

/// A point of radiant intensity 1, in the mesh's space.
Lamp point_at(const glm::dvec3& lamp_place) {
  const auto at = [lamp_place](const glm::dvec3& place, const glm::dvec2&) {
    const glm::dvec3 away = lamp_place - place;
    return LampRay{glm::normalize(away), 1.0 / glm::dot(away, away), glm::length(away)};
  };
  return {at, "a point\n"};
}

/// How far a line goes through the plates of shapes.h from `place`, which is in one of them.
double way_through_plates(const glm::dvec3& place, const glm::dvec3& direction, double height, double gap) {
  double way = 0.0;
  for (const double middle : {-0.5 * (gap + height), 0.5 * (gap + height)}) {
    const glm::dvec3 half(1.0, 1.0, 0.5 * height);
    double from = 0.0;
    double until = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
      const double offset = place[axis] - (axis == 2 ? middle : 0.0);
      const double a = (-half[axis] - offset) / direction[axis];
      const double b = (half[axis] - offset) / direction[axis];
      from = std::max(from, std::min(a, b));
      until = std::min(until, std::max(a, b));
    }
    way += std::max(0.0, until - from);
  }
  return way;
}

// exp(-sigma_t way) of the lamp's irradiance at each place, over all directions: into and through both plates, the
// lower of which has light through the upper one alone.
TEST(Lamp, ShinesStraightThroughWhatIsMatched) {
  constexpr double height = 0.8;
  constexpr double gap = 0.4;
  constexpr double sigma_t = 1.5;  // per unit of the mesh
  const Body body(plates(static_cast<float>(height), static_cast<float>(gap)));
  const Grid grid(body, 4000);
  const glm::dvec3 lamp_place(0.4, -0.3, 1.9);
  const std::vector<float> found =
      unscattered_light(body, grid, Interface(1.0), {sigma_t * body.unit()}, 400000, point_at(lamp_place), {});
  double off = 0.0;
  double all = 0.0;
  for (std::size_t node = 0; node < found.size(); ++node) {
    const glm::dvec3 place = body.unit() * (glm::dvec3(grid.places()[node]) * body.axes());
    const double inside = std::min(1.0 - std::max(std::abs(place.x), std::abs(place.y)),
                                   0.5 * height - std::abs(std::abs(place.z) - 0.5 * (gap + height)));
    if (inside < 0.15) continue;  // what the surface cuts off of a node's cells is not this formula
    const glm::dvec3 away = lamp_place - place;
    const double expected = std::exp(-sigma_t * way_through_plates(place, glm::normalize(away), height, gap)) /
                            (glm::dot(away, away) * 4.0 * std::numbers::pi);
    off += std::abs(found[node] - expected);
    all += expected;
  }
  EXPECT_GT(all, 0.0);
  EXPECT_LT(off / all, 0.06);  // measured 0.03, the rays' noise
}

/// Of one channel at every node of the box.
std::vector<double> sources_from(const StoredTransport& stored, std::size_t texel, std::size_t channel) {
  std::vector<double> sources(stored.nodes(), 0.0);
  for (std::size_t term = 0; term < static_cast<std::size_t>(stored.terms); ++term)
    for (std::size_t node = 0; node < stored.nodes(); ++node)
      sources[node] += stored.sources[term * stored.nodes() + node] * stored.lobes[stored.lobe(term, texel, channel)];
  return sources;
}

TEST(Lamp, IsParallelLightFarAway) {
  constexpr std::size_t texel = 5 * octahedron_side + 9;
  const glm::dvec3 direction(octahedron_direction(static_cast<int>(texel)));
  constexpr double away = 1e4;
  for (const double eta : {1.0, 1.4}) {
    // Measured 0.03 and 0.07: products smooth the edges of what is refracted, which a lamp's one column has.
    const double most = eta == 1.0 ? 0.04 : 0.1;
    const auto body = std::make_shared<const Body>(cube());
    Walks walks(body, Interface(eta), many_rays, {});
    const StoredMedium medium{body->unit() * glm::dvec3(0.5, 1.0, 1.5), {0.95, 0.9, 0.5}, eta};
    const StoredTransport parallel = compute_transport(walks, medium);
    const StoredTransport lamp = compute_transport(walks, medium, point_at(away * (direction * body->axes())));
    ASSERT_EQ(lamp.terms, 3);
    ASSERT_EQ(lamp.size, parallel.size);
    EXPECT_EQ(lamp.has_unscattered, parallel.has_unscattered);
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const std::vector<double> one = sources_from(parallel, texel, channel);
      const std::vector<double> other = sources_from(lamp, 0, channel);
      double off = 0.0;
      double all = 0.0;
      double total = 0.0;
      for (std::size_t node = 0; node < one.size(); ++node) {
        off += std::abs(away * away * other[node] - one[node]);
        total += away * away * other[node];
        all += one[node];
      }
      EXPECT_LT(off / all, most) << "eta " << eta << ", channel " << channel;
      EXPECT_NEAR(total / all, 1.0, 0.01) << "eta " << eta << ", channel " << channel;
    }
  }
}

TEST(Lamp, IsTheSameHoweverManyThreadsFollowIt) {
  constexpr Quality quick{.nodes = 400, .light_across = 4, .way_across = 4};
  const auto body = std::make_shared<const Body>(cube());
  const StoredMedium medium{glm::dvec3(2.0), glm::dvec3(0.9), 1.3};
  Walks walks(body, Interface(1.3), quick, {});
  const Lamp lamp = point_at({0.0, 0.3, 2.0});
  const StoredTransport one = compute_transport(walks, medium, lamp, {.threads = 1});
  EXPECT_EQ(one.sources, compute_transport(walks, medium, lamp, {.threads = 3}).sources);
  EXPECT_EQ(one.channels, 1);
}

TEST(Lamp, ThatShinesElsewhereGivesNothing) {
  constexpr Quality quick{.nodes = 400, .light_across = 4, .way_across = 4};
  const auto body = std::make_shared<const Body>(cube());
  Walks walks(body, Interface(1.3), quick, {});
  Lamp lamp = point_at({0.0, 0.3, 2.0});
  lamp.at = [](const glm::dvec3&, const glm::dvec2&) { return LampRay{{0.0, 0.0, 1.0}, 0.0, 1e30}; };
  const StoredTransport stored = compute_transport(walks, {glm::dvec3(2.0), glm::dvec3(0.9), 1.3}, lamp);
  for (const float source : stored.sources) EXPECT_EQ(source, 0.0F);
}

}  // namespace
}  // namespace mesograin::transport

// Asks at places along rays back from the nodes, where light would have been scattered towards them, how much of the
// sun's is left there.
#include "transport/scattered_once.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "transport/directions.h"
#include "transport/interface.h"
#include "transport/light_ways.h"
#include "transport/random.h"
#include "transport/way_back.h"

namespace mesograin::transport {
namespace {

// Rays from each node, squared, and places along each.
constexpr int rays_back_across = 8;
constexpr int places_a_ray = 4;

// Points of a sun that are told apart, squared, if they do not all lie within an angle of this cosine, about a degree.
constexpr int sun_points_across = 4;
constexpr double narrow = 0.9998;
constexpr int lines_of_a_point = 1 << 14;

struct SunPoint {
  LightWays ways;
  double irradiance;
};

/// One, if the sun is narrow.
std::vector<SunPoint> points_of(const Body& body, const Lamp& sun) {
  std::vector<LampRay> rays;
  double least_cosine = 1.0;
  double irradiance = 0.0;
  glm::dvec3 middle(0.0);
  for (int y = 0; y < sun_points_across; ++y)
    for (int x = 0; x < sun_points_across; ++x) {
      const LampRay ray = sun.at(glm::dvec3(0.0), (glm::dvec2(x, y) + 0.5) / static_cast<double>(sun_points_across));
      rays.push_back(ray);
      least_cosine = std::min(least_cosine, glm::dot(rays.front().to_lamp, ray.to_lamp));
      irradiance += ray.irradiance / (sun_points_across * sun_points_across);
      middle += ray.irradiance * ray.to_lamp;
    }
  std::vector<SunPoint> points;
  if (!(irradiance > 0.0)) return points;
  if (least_cosine >= narrow) {
    points.push_back({LightWays(body, glm::vec3(body.axes() * middle)), irradiance});
    return points;
  }
  for (const LampRay& ray : rays)
    points.push_back({LightWays(body, glm::vec3(body.axes() * ray.to_lamp), lines_of_a_point), ray.irradiance});
  return points;
}

/// Of those, one.
const SunPoint& drawn_from(const std::vector<SunPoint>& points, Random& random) {
  if (points.size() == 1) return points.front();
  return points[static_cast<std::size_t>(random.uniform() * static_cast<float>(points.size()))];
}

}  // namespace

Lights scattered_once(const Body& body, const Grid& grid, const std::vector<double>& extinctions, const Lamp& lamp,
                      const Effort& effort) {
  const std::size_t count = grid.places().size();
  Lights light = Lights::Zero(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(extinctions.size()));
  const std::vector<SunPoint> points = points_of(body, lamp);
  if (points.empty()) return light;
  const Interface matched(1.0);
  constexpr float share = 1.0F / (rays_back_across * rays_back_across * places_a_ray);
  constexpr std::size_t nodes_a_piece = 64;
  run_pieces(effort, (count + nodes_a_piece - 1) / nodes_a_piece, [&](std::size_t piece) {
    WayBack way;
    for (std::size_t node = piece * nodes_a_piece; node < std::min(count, (piece + 1) * nodes_a_piece); ++node) {
      Random random(effort.seed + 2, node);
      auto row = light.row(static_cast<Eigen::Index>(node));
      for (int ray = 0; ray < rays_back_across * rays_back_across; ++ray) {
        const int line = ray / rays_back_across;
        const glm::vec3 direction =
            isotropic((static_cast<float>(ray % rays_back_across) + random.uniform()) / rays_back_across,
                      (static_cast<float>(line) + random.uniform()) / rays_back_across);
        find_way(body, matched, grid.places()[node], direction, 0.0F, random, way);
        if (way.segments.empty()) continue;
        for (int i = 0; i < places_a_ray; ++i) {
          const float u = (static_cast<float>(i) + random.uniform()) / places_a_ray;
          const SunPoint& point = drawn_from(points, random);
          for (std::size_t e = 0; e < extinctions.size(); ++e) {
            const auto sigma_t = static_cast<float>(extinctions[e]);
            const float within = -std::expm1(-sigma_t * way.length());
            const float distance =
                sigma_t * way.length() > 1e-4F ? -std::log1p(-u * within) / sigma_t : u * way.length();
            row[static_cast<Eigen::Index>(e)] += static_cast<float>(point.irradiance) * within *
                                                 std::exp(-sigma_t * point.ways.way(way.place_at(distance)));
          }
        }
      }
    }
  });
  return light * (share / (4.0F * std::numbers::pi_v<float>));
}

}  // namespace mesograin::transport

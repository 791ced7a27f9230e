// Follows view rays into the body, as models/transport.glsl does.
#include "transport/sights.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>
#include <vector>

#include "physics/physics.h"
#include "transport/directions.h"
#include "transport/incidence.h"
#include "transport/random.h"

namespace mesograin::transport {
namespace {

constexpr int views = 48;
constexpr int blocks_across = 12;
constexpr int rays_across = 3;  // of a block
constexpr int most_ways = 4;
constexpr int first_samples = 4;
constexpr int further_samples = 2;
constexpr float least_left = 0.02F;

/// Evenly spread over the sphere (Swinbank and Purser, "Fibonacci grids", 2006).
glm::vec3 side(int view) {
  const float golden_angle = std::numbers::pi_v<float> * (3.0F - std::sqrt(5.0F));
  const auto number = static_cast<float>(view);
  const float z = 1.0F - (2.0F * number + 1.0F) / views;
  const float sine = std::sqrt(1.0F - z * z);
  return {sine * std::cos(golden_angle * number), sine * std::sin(golden_angle * number), z};
}

// How much each node counts, and which do.
class SeenNodes {
 public:
  explicit SeenNodes(std::size_t nodes) : amounts_(nodes, 0.0F) {}

  void add(const Grid& grid, const glm::vec3& place, float amount) {
    for (const Corner& corner : grid.corners(place)) {
      const auto node = static_cast<std::size_t>(corner.node);
      if (amounts_[node] == 0.0F) nodes_.push_back(corner.node);
      amounts_[node] += amount * corner.weight;
    }
  }

  void take(int row, std::vector<Eigen::Triplet<float>>& entries) {
    for (const int node : nodes_) {
      float& amount = amounts_[static_cast<std::size_t>(node)];
      if (amount != 0.0F) entries.emplace_back(row, node, amount);
      amount = 0.0F;
    }
    nodes_.clear();
  }

 private:
  std::vector<float> amounts_;
  std::vector<int> nodes_;
};

void look_into(const Body& body, const Grid& grid, float eta, float sigma_t, glm::vec3 place, glm::vec3 direction,
               float left, Random& random, SeenNodes& nodes) {
  for (int i = 0; i < most_ways && left > least_left / (rays_across * rays_across); ++i) {
    const std::optional<Hit> hit = body.first_hit(place, direction);
    const float cosine = hit ? std::min(glm::dot(hit->normal, direction), 1.0F) : 0.0F;
    if (cosine <= 0.0F) return;
    const float thickness = sigma_t * hit->distance;
    const float within = -std::expm1(-thickness);
    const int samples = i == 0 ? first_samples : further_samples;
    for (int sample = 0; sample < samples; ++sample) {
      const float u = (static_cast<float>(sample) + random.uniform()) / static_cast<float>(samples);
      const float way = thickness > 1e-4F ? -std::log1p(-u * within) / sigma_t : u * hit->distance;
      nodes.add(grid, place + way * direction, left * within / static_cast<float>(samples));
    }
    if (eta == 1.0F) return;
    left *= (1.0F - within) * static_cast<float>(physics::fresnel_reflectance(cosine, 1.0 / eta));
    place += hit->distance * direction;
    direction = glm::normalize(direction - 2.0F * cosine * hit->normal);
  }
}

}  // namespace

Sights sights(const Body& body, const Grid& grid, double eta, double sigma_t, const Effort& effort) {
  constexpr int blocks = blocks_across * blocks_across;
  const auto index = static_cast<float>(eta);
  std::vector<std::vector<Eigen::Triplet<float>>> parts(views);
  Effort quiet = effort;
  quiet.progress = {};
  run_pieces(quiet, views, [&](std::size_t view) {
    const auto number = static_cast<int>(view);
    const Incidence rays(body, side(number));
    const glm::vec3 towards = -rays.to_light();
    Random random(effort.seed + 2, view);
    SeenNodes nodes(grid.places().size());
    for (int block = 0; block < blocks; ++block) {
      const glm::ivec2 corner(block % blocks_across, block / blocks_across);
      for (int ray = 0; ray < rays_across * rays_across; ++ray) {
        const glm::ivec2 part(ray % rays_across, ray / rays_across);
        const glm::vec2 within = glm::vec2(part) + glm::vec2(random.uniform(), random.uniform());
        const glm::vec2 at = (glm::vec2(corner) + within / static_cast<float>(rays_across)) / float{blocks_across};
        const glm::vec3 start = rays.start(at.x, at.y);
        const std::optional<Hit> hit = body.first_hit(start, towards);
        const float cosine = hit ? -glm::dot(hit->normal, towards) : 0.0F;
        if (cosine <= 0.0F) continue;
        const auto transmitted = static_cast<float>(1.0 - physics::fresnel_reflectance(std::min(cosine, 1.0F), eta)) /
                                 (rays_across * rays_across);
        look_into(body, grid, index, static_cast<float>(sigma_t), start + hit->distance * towards,
                  eta == 1.0 ? towards : refracted(towards, hit->normal, index), transmitted, random, nodes);
      }
      nodes.take(number * blocks + block, parts[view]);
    }
  });
  std::vector<Eigen::Triplet<float>> entries;
  for (const auto& part : parts) entries.insert(entries.end(), part.begin(), part.end());
  Sights seen(views * blocks, static_cast<Eigen::Index>(grid.places().size()));
  seen.setFromTriplets(entries.begin(), entries.end());
  return seen;
}

}  // namespace mesograin::transport

// Two corrections. A line between two nodes lies h^2 f''/12 above f in the mean: light that falls off within few
// spacings would reach too far at each scattering, and to what looks in. And a node beyond the surface knows the light
// at the surface's nearest point, or a little below, as if it were that far out: light is taken to go on there as it
// rises below.
#include "transport/between_nodes.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <vector>

namespace mesograin::transport {
namespace {

// Places of nodes on the surface are as far from them, in the body's units.
constexpr float on_surface = 2e-4F;

// Cosine between the way to a place straight below the surface and the normal there.
constexpr float straight_below = 0.7F;

// In squared spacings: light is not followed outwards from nodes that are nearer below the surface.
constexpr float least_depth_squared = 0.05F;

class Nodes {
 public:
  explicit Nodes(const Grid& grid) : grid_(grid) {}

  /// The used node there, or -1.
  int used(const glm::ivec3& node) const {
    if (glm::any(glm::lessThan(node, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(node, grid_.size()))) return -1;
    const int number = (node.z * grid_.size().y + node.y) * grid_.size().x + node.x;
    return grid_.used()[static_cast<std::size_t>(number)];
  }

  /// How far outside the body a used node is.
  float beyond(const glm::ivec3& node) const {
    const glm::vec3 place = grid_.lower() + glm::vec3(node) * grid_.spacing();
    return glm::max(glm::distance(place, place_of(used(node))) - on_surface, 0.0F);
  }

  bool inside(const glm::ivec3& node) const { return used(node) >= 0 && beyond(node) <= 0.0F; }

  const glm::vec3& place_of(int used) const { return grid_.places()[static_cast<std::size_t>(used)]; }

  float depth_of(int used) const { return grid_.depths()[static_cast<std::size_t>(used)]; }

 private:
  const Grid& grid_;
};

using Entries = std::vector<Eigen::Triplet<float>>;

// Takes the mean bend off, along each axis that the light is known along on both sides.
void straighten(const Nodes& nodes, const glm::ivec3& node, Entries& entries) {
  constexpr float share = 1.0F / 12.0F;
  const int self = nodes.used(node);
  for (int axis = 0; axis < 3; ++axis) {
    glm::ivec3 before = node, after = node;
    --before[axis];
    ++after[axis];
    if (!nodes.inside(before) || !nodes.inside(after)) continue;
    entries.emplace_back(self, self, 2.0F * share);
    entries.emplace_back(self, nodes.used(before), -share);
    entries.emplace_back(self, nodes.used(after), -share);
  }
}

// Goes on outwards by the slope (least squares) of what is below the surface there.
void extrapolate(const Nodes& nodes, const glm::ivec3& node, float spacing, Entries& entries) {
  const int self = nodes.used(node);
  struct Below {
    int node;
    float depth;
  };
  std::vector<Below> below;
  float squares = 0.0F;
  for (int i = 0; i < 27; ++i) {
    const glm::ivec3 near = node + glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1;
    if (!nodes.inside(near)) continue;
    const int other = nodes.used(near);
    const float depth = nodes.depth_of(other) - nodes.depth_of(self);
    if (depth < straight_below * glm::distance(nodes.place_of(other), nodes.place_of(self))) continue;
    below.push_back({other, depth});
    squares += depth * depth;
  }
  if (squares <= least_depth_squared * spacing * spacing) return;
  for (const Below& each : below) {
    const float share = nodes.beyond(node) * each.depth / squares;
    entries.emplace_back(self, self, share);
    entries.emplace_back(self, each.node, -share);
  }
}

}  // namespace

BetweenNodes between_nodes(const Grid& grid) {
  const Nodes nodes(grid);
  const glm::vec3& spacing = grid.spacing();
  const float mean_spacing = std::cbrt(spacing.x * spacing.y * spacing.z);
  Entries entries;
  for (int z = 0; z < grid.size().z; ++z)
    for (int y = 0; y < grid.size().y; ++y)
      for (int x = 0; x < grid.size().x; ++x) {
        const glm::ivec3 node(x, y, z);
        const int self = nodes.used(node);
        if (self < 0) continue;
        entries.emplace_back(self, self, 1.0F);
        if (!nodes.inside(node))
          extrapolate(nodes, node, mean_spacing, entries);
        else
          straighten(nodes, node, entries);
      }
  const auto count = static_cast<Eigen::Index>(grid.places().size());
  BetweenNodes amounts(count, count);
  amounts.setFromTriplets(entries.begin(), entries.end());
  return amounts;
}

}  // namespace mesograin::transport

// Carries the numbers of the walls' nodes over to those of the grids about the new places.
#include "heap/moved_light.h"

#include <algorithm>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <utility>
#include <vector>

#include "heap/heap.h"

namespace mesograin::heap {
namespace {

// Of a node before, by chance, whose numbers are the mean.
constexpr int draws_a_node = 4;

bool same_ones(const Grains& a, const Grains& b) {
  const auto same_grain = [](const Grain& one, const Grain& other) { return one.kind == other.kind; };
  const auto same_wall = [](const Wall& one, const Wall& other) { return one.kind == other.kind; };
  return a.kinds.size() == b.kinds.size() &&
         std::equal(a.grains.begin(), a.grains.end(), b.grains.begin(), b.grains.end(), same_grain) &&
         std::equal(a.walls.begin(), a.walls.end(), b.walls.begin(), b.walls.end(), same_wall);
}

/// From where a wall is now to where that was; of another mesh, as a deformed one has it, to the same place.
glm::mat4 way_back(const Wall& before, const Wall& now) {
  if (before.mesh != now.mesh || glm::determinant(now.to_heap) == 0.0) return glm::mat4(1.0F);
  return glm::mat4(before.to_heap * glm::inverse(now.to_heap));
}

glm::vec3 normal_of(int side) {
  glm::vec3 normal(0.0F);
  normal[side / 2] = side % 2 == 0 ? 1.0F : -1.0F;
  return normal;
}

/// For each node now, those before from which it has its numbers; as many times as it has more of them.
std::vector<std::vector<std::uint32_t>> sources(const Patches& before, const Patches& now,
                                                const std::vector<glm::mat4>& ways_back) {
  std::vector<std::vector<std::uint32_t>> found(now.nodes().size());
  transport::Random random(1, 0);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Patches::Node& node = now.nodes()[i];
    const glm::mat4& back = ways_back[node.wall];
    const glm::vec3 place(back * glm::vec4(now.middle() + node.home, 1.0F));
    const glm::vec3 normal = glm::mat3(back) * normal_of(node.side);
    for (int draw = 0; draw < draws_a_node; ++draw)
      if (const std::optional<std::uint32_t> source = before.draw(node.wall, place, normal, random))
        found[i].push_back(*source);
  }
  return found;
}

/// The mean over each wall's nodes.
std::vector<Coefficients> means(const Coefficients* of_nodes, const Patches& patches, std::size_t walls) {
  std::vector<Coefficients> sums(walls);
  std::vector<float> counts(walls, 0.0F);
  for (std::size_t i = 0; i < patches.nodes().size(); ++i) {
    const std::uint32_t wall = patches.nodes()[i].wall;
    sums[wall] = sums[wall] + of_nodes[i];
    ++counts[wall];
  }
  for (std::size_t wall = 0; wall < walls; ++wall)
    sums[wall] = sums[wall] * glm::vec3(1.0F / std::max(counts[wall], 1.0F));
  return sums;
}

}  // namespace

std::optional<HeapLight> moved_light(const HeapLight& light, const Grains& before, const Grains& now) {
  if (!same_ones(before, now)) return std::nullopt;
  HeapLight moved = light;
  if (!same_places(before, now)) moved.neighbourhood.reset();
  if (same_walls(before.walls, now.walls)) return moved;
  moved.patches = patches_about(now);
  std::vector<glm::mat4> ways_back;
  ways_back.reserve(now.walls.size());
  for (std::size_t wall = 0; wall < now.walls.size(); ++wall)
    ways_back.push_back(way_back(before.walls[wall], now.walls[wall]));
  const std::vector<std::vector<std::uint32_t>> from = sources(light.patches, moved.patches, ways_back);
  const std::size_t told = light.seats->told();
  const auto carry = [&](Field& field) {
    if (field.size() != told + light.patches.nodes().size()) return;  // none of walls
    const std::vector<Coefficients> of_nodes(field.begin() + static_cast<std::ptrdiff_t>(told), field.end());
    const std::vector<Coefficients> mean = means(of_nodes.data(), light.patches, now.walls.size());
    field.resize(told + from.size());
    for (std::size_t i = 0; i < from.size(); ++i) {
      Coefficients sum;
      for (const std::uint32_t source : from[i]) sum = sum + of_nodes[source];
      field[told + i] = from[i].empty() ? mean[moved.patches.nodes()[i].wall]
                                        : sum * glm::vec3(1.0F / static_cast<float>(from[i].size()));
    }
  };
  for (Field* field : {&moved.answer, &moved.crossed, &moved.behind, &moved.scattered, &moved.scattered_answer})
    carry(*field);
  Field sent = moved.sent;
  carry(sent);
  moved.sent = SharedField(std::move(sent));
  return moved;
}

}  // namespace mesograin::heap

// Each triangle marks the cells that it lies in, level by level.
#include "heap/patches.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <unordered_map>

namespace mesograin::heap {
namespace {

// How far from the grains' box, in lengths of its cells, a level reaches; the next begins to mix with it before its
// end. As shaders/heap/light_of_walls.glsl has them.
constexpr float level_reach = 8.0F;
constexpr float mixed_from = 0.75F;
constexpr float cell_depth = 2.0F;  // in its lengths: a surface that faces an axis most rises by less than this
constexpr int most_levels = 24;
constexpr int most_probes = 8;

// Across half of a hollow grain.
constexpr float cells_of_hollow = 12.0F;

// Cells are found for what lies so near to them, in their lengths, that rounding may take it for theirs.
constexpr float margin = 0.02F;

// The cosine with an axis from which on smooth normals between those of a triangle's corners may face it most.
constexpr float may_face = 0.5F;

int side_of(const glm::vec3& normal) {
  const glm::vec3 size = glm::abs(normal);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  return 2 * axis + (normal[axis] < 0.0F ? 1 : 0);
}

glm::vec2 across(const glm::vec3& place, int side) {
  const int axis = side / 2;
  return {place[(axis + 1) % 3], place[(axis + 2) % 3]};
}

/// Whether a square and a triangle have a place in common (their separating axes: the triangle's edges; the bounds are
/// known to overlap).
bool overlap(const glm::vec2& lower, const glm::vec2& upper, const std::array<glm::vec2, 3>& triangle) {
  const glm::vec2 middle = 0.5F * (lower + upper);
  const glm::vec2 half = 0.5F * (upper - lower);
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::vec2 edge = triangle[(i + 1) % 3] - triangle[i];
    const glm::vec2 normal(-edge.y, edge.x);
    const float third = glm::dot(normal, triangle[(i + 2) % 3] - triangle[i]);
    const float most = glm::dot(normal, middle - triangle[i]);
    const float reach = glm::dot(glm::abs(normal), half);
    if (third >= 0.0F ? most + reach < 0.0F || most - reach > third : most - reach > 0.0F || most + reach < third)
      return false;
  }
  return true;
}

/// On the triangle.
glm::vec2 nearest_place(const glm::vec2& to, const std::array<glm::vec2, 3>& triangle) {
  glm::vec2 nearest = triangle[0];
  bool left = false;
  bool right = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::vec2 edge = triangle[(i + 1) % 3] - triangle[i];
    const glm::vec2 from = to - triangle[i];
    (edge.x * from.y - edge.y * from.x >= 0.0F ? left : right) = true;
    const float along = glm::clamp(glm::dot(from, edge) / std::max(glm::dot(edge, edge), 1e-30F), 0.0F, 1.0F);
    const glm::vec2 there = triangle[i] + along * edge;
    if (glm::distance(there, to) < glm::distance(nearest, to)) nearest = there;
  }
  return left != right ? to : nearest;
}

std::uint32_t hash(const glm::ivec3& at, std::uint32_t tag) {
  std::uint32_t bits = static_cast<std::uint32_t>(at.x) * 73856093U ^ static_cast<std::uint32_t>(at.y) * 19349663U ^
                       static_cast<std::uint32_t>(at.z) * 83492791U ^ tag * 2654435761U;
  bits ^= bits >> 16U;
  bits *= 0x7feb352dU;
  return bits ^ (bits >> 15U);
}

struct Key {
  glm::ivec3 at;
  std::uint32_t tag;
  bool operator==(const Key&) const = default;
};

struct KeyHash {
  std::size_t operator()(const Key& key) const { return hash(key.at, key.tag); }
};

float median_radius(const Grains& grains) {
  std::vector<float> radii;
  for (const Grain& grain : grains.grains) radii.push_back(grain.radius);
  const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
  std::nth_element(radii.begin(), middle, radii.end());
  return *middle;
}

}  // namespace

std::uint32_t Patches::tag(std::uint32_t wall, int side, int level) {
  return (wall << 8U) | (static_cast<std::uint32_t>(side) << 5U) | static_cast<std::uint32_t>(level);
}

float Patches::length(int level) const { return std::ldexp(spacing_, level); }

float Patches::distance(const glm::vec3& from_middle) const {
  const glm::vec3 beyond = glm::abs(from_middle) - half_;
  return std::max({beyond.x, beyond.y, beyond.z, 0.0F});
}

class Patches::Builder {
 public:
  Builder(Patches& patches, std::size_t most_nodes) : patches_(patches), most_nodes_(most_nodes) {}

  /// False if there would be too many nodes.
  bool add(std::uint32_t number, const Wall& wall) {
    const std::vector<glm::vec3> positions = places_of(*wall.mesh, wall.to_heap);
    const glm::dmat3 linear(wall.to_heap);
    const float mirrored = glm::determinant(linear) < 0.0 ? -1.0F : 1.0F;
    const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                               glm::cross(linear[0], linear[1]));
    const bool open = wall.open();
    for (const glm::uvec3& triangle : wall.mesh->triangles()) {
      const std::array<glm::vec3, 3> corners = {positions[triangle.x] - patches_.middle_,
                                                positions[triangle.y] - patches_.middle_,
                                                positions[triangle.z] - patches_.middle_};
      const glm::vec3 flat = mirrored * glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
      if (!(glm::length(flat) > 0.0F)) continue;
      const glm::vec3 facing = glm::normalize(flat);
      for (int side = 0; side < 6; ++side) {
        const auto faces = [&](const glm::vec3& normal) {
          const float cosine = (side % 2 == 0 ? 1.0F : -1.0F) * normal[side / 2];
          return open ? std::abs(cosine) : cosine;
        };
        float most = faces(facing);
        for (int corner = 0; corner < 3; ++corner) {
          const glm::dvec3 normal = cofactors * glm::dvec3(wall.mesh->normals()[triangle[corner]]);
          if (glm::length(normal) > 0.0) most = std::max(most, faces(mirrored * glm::vec3(glm::normalize(normal))));
        }
        if (most > may_face && !add(number, side, corners, facing)) return false;
      }
    }
    return true;
  }

  /// Into the table that is looked up.
  void finish() {
    std::size_t size = std::bit_ceil(2 * cells_.size() + 1);
    while (!fill(size)) size *= 2;
  }

 private:
  bool fill(std::size_t size) {
    patches_.cells_.assign(size, {});
    for (const auto& [key, nodes] : cells_) {
      const std::optional<std::size_t> slot = patches_.slot(key.at, key.tag);
      if (!slot) return false;
      patches_.cells_[*slot] = {key.at, key.tag, nodes};
    }
    return true;
  }

  struct Facet {
    std::uint32_t wall;
    int side;
    int level;
    std::array<glm::vec2, 3> corners;  // in the level's lengths
    glm::vec2 lower;
    glm::vec2 upper;
    float least_depth;
    float most_depth;
    float depth_at_first;
    glm::vec2 slope;

    float depth(const glm::vec2& at) const {
      // Beyond the triangle its plane may be steep.
      return std::clamp(depth_at_first + glm::dot(slope, at - corners[0]), least_depth - cell_depth,
                        most_depth + cell_depth);
    }
  };

  bool add(std::uint32_t number, int side, const std::array<glm::vec3, 3>& corners, const glm::vec3& facing) {
    const int axis = side / 2;
    const glm::vec3 lower = glm::min(glm::min(corners[0], corners[1]), corners[2]);
    const glm::vec3 upper = glm::max(glm::max(corners[0], corners[1]), corners[2]);
    const float nearest = patches_.distance(glm::clamp(glm::vec3(0.0F), lower, upper));
    const float farthest = std::max(patches_.distance(lower), patches_.distance(upper));
    for (int level = 0; level < most_levels; ++level) {
      const float length = patches_.length(level);
      const float reach = level_reach * length * (1.0F + margin);
      if (reach < nearest) continue;
      // What the level before leaves to this one.
      const float from = level == 0 ? 0.0F : 0.5F * mixed_from * level_reach * length * (1.0F - margin);
      if (from > farthest) break;
      Facet facet{number, side, level, {}, {}, {}, 0.0F, 0.0F, 0.0F, {}};
      for (std::size_t corner = 0; corner < 3; ++corner) facet.corners[corner] = across(corners[corner], side) / length;
      const glm::vec2 part = (across(patches_.half_, side) + reach) / length;
      facet.lower = glm::max(across(lower, side) / length, -part) - margin;
      facet.upper = glm::min(across(upper, side) / length, part) + margin;
      facet.least_depth = lower[axis] / length;
      facet.most_depth = upper[axis] / length;
      facet.depth_at_first = corners[0][axis] / length;
      facet.slope = std::abs(facing[axis]) > 0.1F ? -across(facing, side) / facing[axis] : glm::vec2(0.0F);
      const glm::ivec2 first(glm::floor(facet.lower));
      const glm::ivec2 last(glm::floor(facet.upper));
      for (int v = first.y; v <= last.y; ++v)
        for (int u = first.x; u <= last.x; ++u) {
          if (level > 0 && within({u, v}, side, length, from, lower[axis], upper[axis])) continue;
          mark(facet, {u, v});
          if (patches_.nodes_.size() > most_nodes_) return false;
        }
    }
    return true;
  }

  /// Whether all of a cell is so near that its level is not asked for there.
  bool within(const glm::ivec2& at, int side, float length, float from, float least, float most) const {
    glm::vec3 farthest(0.0F);
    const int axis = side / 2;
    farthest[(axis + 1) % 3] = length * static_cast<float>(std::max(std::abs(at.x), std::abs(at.x + 1)));
    farthest[(axis + 2) % 3] = length * static_cast<float>(std::max(std::abs(at.y), std::abs(at.y + 1)));
    farthest[axis] = std::max(std::abs(least), std::abs(most));
    return patches_.distance(farthest) < from;
  }

  void mark(const Facet& facet, const glm::ivec2& at) {
    const glm::vec2 lower = glm::vec2(at) - margin;
    const glm::vec2 upper = glm::vec2(at + 1) + margin;
    if (!overlap(lower, upper, facet.corners)) return;
    std::array<float, 4> depths{};
    for (int corner = 0; corner < 4; ++corner)
      depths[static_cast<std::size_t>(corner)] = facet.depth(glm::vec2(at + glm::ivec2(corner % 2, corner / 2)));
    const auto [least, most] = std::minmax_element(depths.begin(), depths.end());
    const float low = std::max(*least, facet.least_depth) - margin;
    const float high = std::min(*most, facet.most_depth) + margin;
    for (int depth = static_cast<int>(std::floor(low / cell_depth)); static_cast<float>(depth) * cell_depth <= high;
         ++depth) {
      const Key key{{at, depth}, tag(facet.wall, facet.side, facet.level)};
      const auto [cell, added] = cells_.try_emplace(key);
      if (!added) continue;
      for (int corner = 0; corner < 4; ++corner)
        cell->second[static_cast<std::size_t>(corner)] =
            node(facet, at + glm::ivec2(corner % 2, corner / 2), depths[static_cast<std::size_t>(corner)]);
    }
  }

  /// One of these place and about this depth, so that cells side by side share it.
  std::uint32_t node(const Facet& facet, const glm::ivec2& at, float depth) {
    std::vector<std::uint32_t>& there = nodes_at_[{{at, 0}, tag(facet.wall, facet.side, facet.level)}];
    const float length = patches_.length(facet.level);
    const int axis = facet.side / 2;
    for (const std::uint32_t known : there)
      if (std::abs(patches_.nodes_[known].depth / length - depth) < 0.75F * cell_depth) return known;
    there.push_back(static_cast<std::uint32_t>(patches_.nodes_.size()));
    const glm::vec2 nearest = nearest_place(glm::vec2(at), facet.corners);
    const float depth_there = std::clamp(facet.depth_at_first + glm::dot(facet.slope, nearest - facet.corners[0]),
                                         facet.least_depth, facet.most_depth);
    glm::vec3 home;
    home[axis] = depth_there * length;
    home[(axis + 1) % 3] = nearest.x * length;
    home[(axis + 2) % 3] = nearest.y * length;
    patches_.nodes_.push_back({facet.wall, facet.side, facet.level, at, depth * length, home});
    return there.back();
  }

  Patches& patches_;
  std::size_t most_nodes_;
  std::unordered_map<Key, std::array<std::uint32_t, 4>, KeyHash> cells_;
  std::unordered_map<Key, std::vector<std::uint32_t>, KeyHash> nodes_at_;
};

Patches::Patches(const Grains& grains, std::size_t most_nodes) {
  const bool any_hollow = std::any_of(grains.walls.begin(), grains.walls.end(), std::mem_fn(&Wall::hollow));
  if (grains.walls.empty() || (grains.grains.empty() && !any_hollow)) return;
  glm::vec3 lower(std::numeric_limits<float>::max());
  glm::vec3 upper(-lower);
  for (const Grain& grain : grains.grains) {
    lower = glm::min(lower, grain.middle - grain.radius);
    upper = glm::max(upper, grain.middle + grain.radius);
  }
  // Returns half of the longest side.
  const auto take = [&](const scene::Mesh& mesh, const glm::dmat4& to_heap) {
    glm::vec3 least(std::numeric_limits<float>::max());
    glm::vec3 most(-least);
    for (const glm::vec3& place : places_of(mesh, to_heap)) {
      least = glm::min(least, place);
      most = glm::max(most, place);
    }
    lower = glm::min(lower, least);
    upper = glm::max(upper, most);
    return 0.5F * std::max({most.x - least.x, most.y - least.y, most.z - least.z});
  };
  for (const Pane& pane : grains.panes) take(*pane.mesh, pane.to_heap);
  float shaded = grains.grains.empty() ? std::numeric_limits<float>::max() : 0.5F * median_radius(grains);
  for (const Wall& wall : grains.walls)
    if (wall.hollow) shaded = std::min(shaded, take(*wall.mesh, wall.to_heap) / cells_of_hollow);
  middle_ = 0.5F * (lower + upper);
  half_ = 0.5F * (upper - lower);
  // As fine as grains shade what they lie on, and parts of a hollow one each other, but for a few too many.
  const float largest = std::max({half_.x, half_.y, half_.z});
  spacing_ = std::max({shaded, 1e-4F * largest, 1e-30F});
  for (;; spacing_ *= 1.5F, most_nodes += most_nodes / 4) {
    nodes_.clear();
    Builder builder(*this, most_nodes);
    bool few = true;
    for (std::size_t wall = 0; few && wall < grains.walls.size(); ++wall)
      few = builder.add(static_cast<std::uint32_t>(wall), grains.walls[wall]);
    if (!few) continue;
    builder.finish();
    return;
  }
}

std::optional<std::size_t> Patches::slot(const glm::ivec3& at, std::uint32_t tag) const {
  const std::size_t mask = cells_.size() - 1;
  std::size_t slot = hash(at, tag) & mask;
  for (int probe = 0; probe < most_probes; ++probe, slot = (slot + 1) & mask)
    if (cells_[slot].tag == no_cell || (cells_[slot].tag == tag && cells_[slot].at == at)) return slot;
  return std::nullopt;
}

std::optional<std::uint32_t> Patches::draw(std::uint32_t wall, const glm::vec3& place, const glm::vec3& normal,
                                           transport::Random& random) const {
  const glm::vec3 from_middle = place - middle_;
  const int side = side_of(normal);
  const float levels = distance(from_middle) / (level_reach * spacing_);
  int level = levels < 1.0F ? 0 : std::min(static_cast<int>(std::log2(levels)) + 1, most_levels - 1);
  const float share = (std::ldexp(levels, -level) - mixed_from) / (1.0F - mixed_from);
  if (random.uniform() < share) level = std::min(level + 1, most_levels - 1);
  const glm::vec2 at = across(from_middle, side) / length(level);
  const glm::vec2 cell_at = glm::floor(at);
  const int depth = static_cast<int>(std::floor(from_middle[side / 2] / (cell_depth * length(level))));
  const std::optional<std::size_t> found = slot({glm::ivec2(cell_at), depth}, tag(wall, side, level));
  if (!found || cells_[*found].tag == no_cell) return std::nullopt;
  const Cell& cell = cells_[*found];
  const std::size_t u = random.uniform() < at.x - cell_at.x ? 1 : 0;
  const std::size_t v = random.uniform() < at.y - cell_at.y ? 2 : 0;
  return cell.nodes[u + v];
}

std::vector<glm::uvec4> Patches::packed(std::uint32_t first_value) const {
  const auto bits = [](const glm::vec3& numbers, std::uint32_t last) {
    return glm::uvec4(std::bit_cast<std::uint32_t>(numbers.x), std::bit_cast<std::uint32_t>(numbers.y),
                      std::bit_cast<std::uint32_t>(numbers.z), last);
  };
  std::vector<glm::uvec4> packed;
  packed.reserve(3 + 2 * cells_.size());
  packed.push_back(bits(middle_, std::bit_cast<std::uint32_t>(spacing_)));
  packed.push_back(bits(half_, static_cast<std::uint32_t>(cells_.size()) - 1));
  packed.emplace_back(first_value, 0, 0, 0);
  for (const Cell& cell : cells_) {
    packed.emplace_back(glm::uvec3(cell.at), cell.tag);
    packed.emplace_back(cell.nodes[0], cell.nodes[1], cell.nodes[2], cell.nodes[3]);
  }
  return packed;
}

}  // namespace mesograin::heap

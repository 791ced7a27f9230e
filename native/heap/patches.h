// Grids on walls, at whose nodes it is known what they send out: fine about the heap, twice as coarse at twice the
// distance. A cell lies in the plane of two of the heap's axes, across the one that its surface faces most, and is as
// deep as surfaces there may be steep; between its four nodes light is linear. shaders/heap/light_of_walls.glsl reads
// the same.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <vector>

#include "heap/grains.h"
#include "transport/random.h"

namespace mesograin::heap {

class Patches {
 public:
  /// A corner of cells. `side`: twice the axis that its surface faces most, and one more if it faces against it.
  struct Node {
    std::uint32_t wall;
    int side;
    int level;
    glm::ivec2 at;   ///< in the cells' lengths from middle()
    float depth;     ///< along the axis, from middle()
    glm::vec3 home;  ///< a place on the wall that is near, from middle()

    bool operator==(const Node&) const = default;
  };

  Patches() = default;

  bool operator==(const Patches&) const = default;

  /// `most_nodes`: the grids are as coarse as that asks for.
  Patches(const Grains& grains, std::size_t most_nodes);

  const std::vector<Node>& nodes() const { return nodes_; }

  const glm::vec3& middle() const { return middle_; }

  /// The length of a level's cells.
  float length(int level) const;

  /// A node that is the likelier the more of what is sent out at a place comes from it. Nothing where no cell is.
  std::optional<std::uint32_t> draw(std::uint32_t wall, const glm::vec3& place, const glm::vec3& normal,
                                    transport::Random& random) const;

  /// As shaders read it: where the grids are, and the cells by their hash. `first_value`: where the shader's numbers of
  /// the nodes begin.
  std::vector<glm::uvec4> packed(std::uint32_t first_value) const;

 private:
  struct Cell {
    glm::ivec3 at{0};  // along the axes across, and in its own depths along the one that it faces
    std::uint32_t tag = no_cell;
    std::array<std::uint32_t, 4> nodes{};

    bool operator==(const Cell&) const = default;
  };
  static constexpr std::uint32_t no_cell = ~0U;

  class Builder;

  static std::uint32_t tag(std::uint32_t wall, int side, int level);
  /// Where this cell is, or has room; nothing where it has none.
  std::optional<std::size_t> slot(const glm::ivec3& at, std::uint32_t tag) const;
  float distance(const glm::vec3& from_middle) const;

  glm::vec3 middle_{0.0F};
  glm::vec3 half_{0.0F};  // of the box around the grains
  float spacing_ = 1.0F;
  std::vector<Node> nodes_;
  std::vector<Cell> cells_;  // open addressing, a power of 2
};

}  // namespace mesograin::heap

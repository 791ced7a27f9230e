// The nodes that light inside a body is known at: a box of them, linear in between.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "transport/body.h"
#include "transport/effort.h"

namespace mesograin::transport {

/// A node's share of what is at some place.
struct Corner {
  int node;
  float weight;
};

/// How nodes are shared out among the three sides of the body's box: in proportion to a side, or to its root, so that
/// they are nearer to one another across a thin body, where light changes within shorter ways than along it.
enum class Spacing { even, nearer_across };

/// Corner nodes lie on the body's box. Used are all nodes of cells that the body reaches into; those that lie outside
/// it stand for a place below the point of its surface that is nearest to them.
class Grid {
 public:
  /// About `nodes` spaces between them in the body's box, and no more than `most_nodes` of them. No place is nearer to
  /// the surface than `least_depth` of such a space.
  Grid(const Body& body, int nodes, Spacing spacing = Spacing::even, int most_nodes = std::numeric_limits<int>::max(),
       const Effort& effort = {}, float least_depth = 0.0F);

  const glm::ivec3& size() const { return size_; }
  const glm::vec3& lower() const { return lower_; }
  const glm::vec3& spacing() const { return spacing_; }

  /// The used node at every node of the box, or -1; x runs fastest.
  const std::vector<int>& used() const { return used_; }

  /// Where each used node's light is to be known.
  const std::vector<glm::vec3>& places() const { return places_; }

  /// How far below the surface each used node's place is.
  const std::vector<float>& depths() const { return depths_; }

  /// How much of the body is each used node's: the integral of its weight.
  const std::vector<float>& volumes() const { return volumes_; }

  /// The used node that answers for light that passes each used node: most do it themselves, those that hardly any of
  /// the body belongs to have a neighbour.
  const std::vector<int>& deputies() const { return deputies_; }

  /// Eight nodes next to one another, the used ones of which answer for what is between them; -1 where one is not used.
  struct Cell {
    std::array<int, 8> used;
    bool whole;  ///< all corners are used
  };

  /// x runs fastest.
  const std::vector<Cell>& cells() const { return cells_; }

  /// The used nodes around a place inside the body; their weights make 1.
  std::array<Corner, 8> corners(const glm::vec3& place) const;

  /// One of them, as often as its weight says for `random` uniform in [0, 1), each for itself.
  int corner(const glm::vec3& place, const glm::vec3& random) const;

 private:
  std::size_t index(const glm::ivec3& node) const;
  const Cell& cell(const glm::vec3& place, glm::vec3& along) const;
  void list_cells();
  void measure_volumes(const Body& body);
  void choose_deputies();

  glm::ivec3 size_{2};
  glm::vec3 lower_{0.0F};
  glm::vec3 spacing_{1.0F};
  std::vector<int> used_;
  std::vector<Cell> cells_;
  std::vector<glm::vec3> places_;
  std::vector<float> depths_;
  std::vector<float> volumes_;
  std::vector<int> deputies_;
};

}  // namespace mesograin::transport

// A view's content as rays meet it, where no hardware draws it faster.
#pragma once

#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "casting/placed_tree.h"
#include "render/content.h"

namespace mesograin::render {

class CastContent {
 public:
  /// `content` must outlive it.
  CastContent(DeviceCache& cache, Content& content);

  /// Of instances of arrays alone; null if there are none.
  const casting::PlacedTree* instances() const { return instances_; }

  /// Three of a draw's transform, as Instances::rows.
  const glm::vec4* rows(std::size_t draw) const { return &rows_[3 * draw]; }

  /// As those of casting::PlacedTree, of everything. Draws have the numbers by which shadows know them.
  void first_hits(casting::Packet& packet, casting::Hits& hits) const;
  void find_occluded(casting::Packet& packet) const;
  std::optional<casting::Hit> first_hit(casting::SingleRay ray) const;
  std::optional<casting::Hit> first_hit_of_draws(const casting::SingleRay& ray) const;

  /// False only if no draw has a place so near to this one.
  bool draws_may_reach(const glm::vec3& place, float distance) const;

 private:
  const casting::PlacedTree* instances_;
  std::vector<glm::vec4> rows_;  // of the draws
  std::unique_ptr<casting::PlacedTree> draws_;
};

}  // namespace mesograin::render

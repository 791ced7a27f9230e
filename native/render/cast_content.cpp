// The tree of the instances is theirs, and lives as long as they stand still; that of the draws is made anew.
#include "render/cast_content.h"

#include <cstddef>
#include <utility>

namespace mesograin::render {

CastContent::CastContent(DeviceCache& cache, Content& content)
    : instances_(content.instances() != nullptr ? &content.instances()->tree(cache) : nullptr) {
  std::vector<casting::PlacedGroup> groups;
  rows_.reserve(3 * content.draws().size());
  for (std::size_t i = 0; i < content.draws().size(); ++i) {
    const Draw& draw = content.draws()[i];
    for (const glm::vec4& row : draw.rows(content.anchor())) rows_.push_back(row);
    groups.push_back(
        {cache.tree(draw.source), rows_.data() + 3 * i, 1, static_cast<std::uint32_t>(content.object_number(i))});
  }
  if (!groups.empty()) draws_ = std::make_unique<casting::PlacedTree>(std::move(groups));
}

void CastContent::first_hits(casting::Packet& packet, casting::Hits& hits) const {
  if (instances_ != nullptr) instances_->first_hits(packet, hits);
  if (draws_ != nullptr) draws_->first_hits(packet, hits);
}

std::optional<casting::Hit> CastContent::first_hit(casting::SingleRay ray) const {
  std::optional<casting::Hit> first;
  for (const casting::PlacedTree* tree : {instances_, static_cast<const casting::PlacedTree*>(draws_.get())}) {
    if (tree == nullptr) continue;
    const std::optional<casting::Hit> hit = tree->first_hit(ray);
    if (!hit) continue;
    first = hit;
    ray.farthest = hit->distance;
  }
  return first;
}

std::optional<casting::Hit> CastContent::first_hit_of_draws(const casting::SingleRay& ray) const {
  return draws_ != nullptr ? draws_->first_hit(ray) : std::nullopt;
}

bool CastContent::draws_may_reach(const glm::vec3& place, float distance) const {
  // Each is asked, which of so many takes longer than rays do.
  constexpr std::size_t most_asked = 64;
  return draws_ != nullptr && (rows_.size() > 3 * most_asked || draws_->may_reach(place, distance));
}

void CastContent::find_occluded(casting::Packet& packet) const {
  if (instances_ != nullptr) instances_->find_occluded(packet);
  if (draws_ != nullptr) draws_->find_occluded(packet);
}

}  // namespace mesograin::render

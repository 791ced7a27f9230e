// How looks into grains go on through a view's content: to a grain's own facets, and to what stands around it.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "heap/facet_walk.h"
#include "render/cast_content.h"
#include "render/content.h"
#include "render/exchange.h"

namespace mesograin::render {

/// All that is given must outlive it.
class ContentFacets : public heap::Facets {
 public:
  ContentFacets(const CastContent& cast, const Content& content, const Exchange& exchange);

  /// A grain where it is seen along a ray (direction of unit length); nothing where something else is.
  std::optional<heap::SeenFacet> seen_along(std::uint32_t grain, const glm::vec3& origin,
                                            const glm::vec3& direction) const;

  std::optional<heap::Meeting> inside(std::uint32_t grain, const glm::vec3& origin,
                                      const glm::vec3& direction) const override;
  std::optional<heap::End> end(std::uint32_t grain, const glm::vec3& origin, const glm::vec3& direction) const override;
  std::optional<heap::Meeting> beyond(std::uint32_t grain, const glm::vec3& origin,
                                      const glm::vec3& direction) const override;
  heap::Finish finish(std::uint32_t grain) const override;

 private:
  struct Hit;
  std::optional<Hit> first_hit(const glm::vec3& origin, const glm::vec3& direction, std::size_t from,
                               float clearance) const;
  /// How far from a place on an object's surface a ray no longer meets that place.
  float clear_of(std::size_t object, const glm::vec3& place) const;
  /// Where a ray meets one instance from inside, or from `clearance` on from its surface.
  std::optional<casting::Hit> own_hit(std::size_t object, const glm::vec3& origin, const glm::vec3& direction,
                                      float clearance) const;
  /// Whether a draw may stand in what an instance fills.
  bool may_be_reached_into(std::size_t object) const;
  /// The wall that it meets before that.
  std::optional<heap::Meeting> wall_before(const std::optional<casting::Hit>& own, const glm::vec3& origin,
                                           const glm::vec3& direction) const;
  Hit place_of(const casting::Hit& hit, const glm::vec3& origin, const glm::vec3& direction) const;
  std::optional<heap::Meeting> wall_at(const Hit& hit, const glm::vec3& direction) const;
  std::size_t instances() const;

  const CastContent& cast_;
  const Content& content_;
  const std::vector<RoleInHeap>& roles_;
  std::vector<std::size_t> objects_;  // their numbers, of the grains
  enum class Reached : std::uint8_t { unknown, perhaps, never };
  mutable std::vector<std::atomic<Reached>> reached_;  // of the instances, as they are asked for
};

}  // namespace mesograin::render

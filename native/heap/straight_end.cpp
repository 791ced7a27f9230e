// Where a look straight into a clear grain ends, if it is nowhere reflected but where it must be: no chance in it, so
// that it tells pixels apart whose looks end by chance.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "heap/gather.h"
#include "transport/directions.h"

namespace mesograin::heap {
namespace {

// Rougher surfaces show nothing clearly.
constexpr float least_rough = 0.02F;

// Of totally reflected light little is told by where it leaves.
constexpr int most_reflected = 8;

/// Whether nothing crosses a facet. `eta`: beyond it over before it.
bool is_totally_reflected(const glm::vec3& travelling, const glm::vec3& normal, float eta) {
  const float cosine = glm::dot(travelling, normal);
  return (1.0F - cosine) * (1.0F + cosine) >= eta * eta;
}

}  // namespace

std::optional<Gather::StraightEnd> Gather::straight_end(SeenFacet seen, const Facets& facets) const {
  glm::vec3 left(1.0F);
  for (int through = 0; through < most_looked_into; ++through) {
    const Optics& of = optics(seen.grain);
    const auto eta = static_cast<float>(of.eta);
    const glm::vec3 absorbed(of.sigma_t * (1.0 - of.albedo) /
                             static_cast<double>(space_.grains()[seen.grain].radius_of_kind()));
    glm::vec3 direction = -seen.towards;
    if (facets.finish(seen.grain).roughness >= least_rough || is_totally_reflected(direction, seen.normal, eta))
      return std::nullopt;
    direction = transport::refracted(direction, seen.normal, eta);
    glm::vec3 place = seen.place;
    bool within = true;
    for (int met = 0; within && met <= most_reflected; ++met) {
      const std::optional<Meeting> facet = facets.inside(seen.grain, place, direction);
      if (!facet) break;
      left *= glm::exp(-glm::distance(place, facet->place) * absorbed);
      if (facet->wall) return StraightEnd{facet, facet->normal, left};
      place = facet->place;
      within = is_totally_reflected(direction, facet->normal, 1.0F / eta);
      direction = within ? glm::normalize(glm::reflect(direction, facet->normal))
                         : transport::refracted(direction, -facet->normal, 1.0F / eta);
    }
    if (within) return std::nullopt;
    const std::optional<Meeting> meeting = facets.beyond(seen.grain, place, direction);
    if (!meeting) return StraightEnd{std::nullopt, direction, left * world_along(direction, true)};
    if (meeting->wall || meeting->number != seen.grain) return StraightEnd{meeting, meeting->normal, left};
    seen = {meeting->number, meeting->place, meeting->normal, -direction};
  }
  return std::nullopt;
}

}  // namespace mesograin::heap

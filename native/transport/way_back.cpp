// Follows the ray from surface to surface, one of both ways at each.
#include "transport/way_back.h"

#include <glm/geometric.hpp>
#include <optional>

namespace mesograin::transport {
namespace {

// What is reflected more often is trapped, and scattered somewhere on the way that is known by then.
constexpr int most_reflections = 12;
// Outside, from one part of the body to another.
constexpr int most_reflections_outside = 4;

/// Whether a ray that has left the body at `place` comes in again; it goes on from there, inside.
bool comes_in_again(const Body& body, const Interface& interface, glm::vec3& place, glm::vec3& direction,
                    Random& random) {
  if (body.convex()) return false;
  for (int reflections = 0; reflections <= most_reflections_outside; ++reflections) {
    const std::optional<Hit> hit = body.first_hit(place, direction);
    if (!hit || glm::dot(hit->normal, direction) >= 0.0F) return false;
    const Interface::Entry entry = interface.enter(direction, hit->normal, random);
    place += hit->distance * direction;
    direction = entry.inwards;
    if (random.uniform() < entry.passed) return true;
    direction = entry.mirrored;
  }
  return false;
}

}  // namespace

void find_way(const Body& body, const Interface& interface, glm::vec3 place, glm::vec3 direction, float longest,
              Random& random, WayBack& way) {
  way.segments.clear();
  way.ends_outside = true;
  float length = 0.0F;
  for (int reflections = 0; reflections <= most_reflections; ++reflections) {
    const std::optional<Hit> hit = body.first_hit(place, direction);
    if (!hit || glm::dot(hit->normal, direction) <= 0.0F) return;
    length += hit->distance;
    way.segments.push_back({place, direction, length});
    if (interface.matched()) {
      const std::optional<glm::vec3> entry = body.next_entry(place + hit->distance * direction, direction);
      if (!entry) return;
      place = *entry;
      continue;
    }
    const Interface::Reflection reflection = interface.reflect(direction, hit->normal, random);
    place += hit->distance * direction;
    direction = reflection.inwards;
    if (random.uniform() >= reflection.reflected) {
      direction = reflection.beyond;
      if (!comes_in_again(body, interface, place, direction, random)) return;
    }
    if (length > longest) break;
  }
  // What is reflected for ever stays until it is scattered.
  way.ends_outside = false;
}

}  // namespace mesograin::transport

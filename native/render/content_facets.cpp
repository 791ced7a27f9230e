// Rays one by one: they go nowhere near each other.
#include "render/content_facets.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "render/hit_surface.h"

namespace mesograin::render {
namespace {

// Of the ball around a grain: how far from its own surface a ray begins that may meet it again.
constexpr float clear_of_itself = 1e-4F;

// The same of how far away it is from where places are told from, for rounding.
constexpr float rounding = 1e-6F;

// The same for a ray that starts from a wall.
constexpr float clear_of_wall = 1e-5F;

// A ray that starts from no object.
constexpr auto nothing = static_cast<std::size_t>(-1);

// What stands in the way and is not meant is passed, so many times.
constexpr int most_passed = 16;

}  // namespace

struct ContentFacets::Hit {
  std::size_t object;
  glm::vec3 place;  // from the anchor
  glm::vec3 normal;
  bool front;
  bool flat;
};

ContentFacets::ContentFacets(const CastContent& cast, const Content& content, const Exchange& exchange)
    : cast_(cast), content_(content), roles_(exchange.roles()) {
  reached_ = std::vector<std::atomic<Reached>>(instances());
  // Grains are counted in the order of the objects.
  for (std::size_t object = 0; object < roles_.size(); ++object)
    if (roles_[object].grain) objects_.push_back(object);
}

std::size_t ContentFacets::instances() const {
  return content_.instances() != nullptr ? content_.instances()->count() : 0;
}

float ContentFacets::clear_of(std::size_t object, const glm::vec3& place) const {
  return std::max(clear_of_itself * content_.receiver(object).ball.w, rounding * glm::length(place));
}

std::optional<ContentFacets::Hit> ContentFacets::first_hit(const glm::vec3& origin, const glm::vec3& direction,
                                                           std::size_t from, float clearance) const {
  casting::SingleRay ray{origin, direction};
  if (from < instances())
    ray.from = static_cast<std::uint32_t>(from);
  else if (from != nothing)
    ray.from = static_cast<std::uint32_t>(content_.object_number(from - instances()));
  ray.own = clearance;
  const std::optional<casting::Hit> hit = cast_.first_hit(ray);
  if (!hit) return std::nullopt;
  return place_of(*hit, origin, direction);
}

ContentFacets::Hit ContentFacets::place_of(const casting::Hit& hit, const glm::vec3& origin,
                                           const glm::vec3& direction) const {
  const HitSurface surface = hit_surface(cast_, content_, direction, hit);
  const glm::vec4& facing = surface.normal;
  return {static_cast<std::size_t>(std::abs(facing.w)) - 1, origin + hit.distance * direction, glm::vec3(facing),
          facing.w > 0.0F, surface.flat};
}

std::optional<heap::SeenFacet> ContentFacets::seen_along(std::uint32_t grain, const glm::vec3& origin,
                                                         const glm::vec3& direction) const {
  const std::optional<Hit> hit = first_hit(origin, direction, nothing, 0.0F);
  if (!hit || hit->object != objects_[grain] || !hit->front) return std::nullopt;
  return heap::SeenFacet{grain, hit->place, hit->normal, -direction};
}

std::optional<casting::Hit> ContentFacets::own_hit(std::size_t object, const glm::vec3& origin,
                                                   const glm::vec3& direction, float clearance) const {
  return cast_.instances()->hit_of(static_cast<std::uint32_t>(object), {origin, direction}, clearance);
}

bool ContentFacets::may_be_reached_into(std::size_t object) const {
  Reached reached = reached_[object].load(std::memory_order_relaxed);
  if (reached == Reached::unknown) {
    const glm::vec4& ball = content_.receiver(object).ball;
    const float far = ball.w + clear_of(object, glm::vec3(ball));
    reached = cast_.draws_may_reach(glm::vec3(ball), far) ? Reached::perhaps : Reached::never;
    reached_[object].store(reached, std::memory_order_relaxed);
  }
  return reached == Reached::perhaps;
}

std::optional<heap::Meeting> ContentFacets::wall_before(const std::optional<casting::Hit>& own, const glm::vec3& origin,
                                                        const glm::vec3& direction) const {
  casting::SingleRay ray{origin, direction};
  if (own) ray.farthest = own->distance;
  const std::optional<casting::Hit> before = cast_.first_hit_of_draws(ray);
  return before ? wall_at(place_of(*before, origin, direction), direction) : std::nullopt;
}

std::optional<heap::End> ContentFacets::end(std::uint32_t grain, const glm::vec3& origin,
                                            const glm::vec3& direction) const {
  const std::size_t object = objects_[grain];
  if (object >= instances()) return Facets::end(grain, origin, direction);
  const std::optional<casting::Hit> own = own_hit(object, origin, direction, clear_of(object, origin));
  // Most grains stand clear of all walls, which then takes a ray less.
  if (own && !may_be_reached_into(object)) return heap::End{own->distance, false};
  if (const std::optional<heap::Meeting> wall = wall_before(own, origin, direction))
    return heap::End{glm::distance(origin, wall->place), true};
  return own ? std::optional(heap::End{own->distance, false}) : std::nullopt;
}

std::optional<heap::Meeting> ContentFacets::inside(std::uint32_t grain, const glm::vec3& origin,
                                                   const glm::vec3& direction) const {
  const std::size_t object = objects_[grain];
  const float clearance = clear_of(object, origin);
  if (object < instances()) {
    const std::optional<casting::Hit> own = own_hit(object, origin, direction, clearance);
    if (!own || may_be_reached_into(object))
      if (const std::optional<heap::Meeting> wall = wall_before(own, origin, direction)) return wall;
    if (!own) return std::nullopt;
    const Hit hit = place_of(*own, origin, direction);
    if (hit.front) return std::nullopt;
    return heap::Meeting{false, grain, hit.place, hit.normal, hit.flat};
  }
  std::optional<Hit> hit = first_hit(origin, direction, object, clearance);
  // Others may reach into it.
  for (int passed = 0; hit && hit->object != object && passed < most_passed; ++passed) {
    if (const std::optional<heap::Meeting> wall = wall_at(*hit, direction)) return wall;
    hit = first_hit(hit->place, direction, hit->object, 0.0F);
  }
  if (!hit || hit->object != object || hit->front) return std::nullopt;
  return heap::Meeting{false, grain, hit->place, hit->normal, hit->flat};
}

std::optional<heap::Meeting> ContentFacets::beyond(std::uint32_t grain, const glm::vec3& origin,
                                                   const glm::vec3& direction) const {
  std::optional<Hit> hit;
  if (grain == heap::nobody) {
    hit = first_hit(origin + clear_of_wall * glm::length(origin) * direction, direction, nothing, 0.0F);
  } else {
    const std::size_t object = objects_[grain];
    const float clearance = clear_of(object, origin);
    // What it lies on begins where it ends. A jar has another wall beyond this one.
    hit = first_hit(origin - clearance * direction, direction, object, roles_[object].pane ? 2.0F * clearance : 0.0F);
  }
  for (int passed = 0; hit && passed < most_passed; ++passed) {
    const RoleInHeap& role = roles_[hit->object];
    // One that reaches into the grain that is looked through is not met from inside.
    if (role.grain && hit->front) return heap::Meeting{false, *role.grain, hit->place, hit->normal};
    if (const std::optional<heap::Meeting> wall = wall_at(*hit, direction)) return wall;
    hit = first_hit(hit->place, direction, hit->object, 0.0F);
  }
  return std::nullopt;
}

std::optional<heap::Meeting> ContentFacets::wall_at(const Hit& hit, const glm::vec3& direction) const {
  const std::optional<std::uint32_t>& wall = roles_[hit.object].wall;
  if (!wall) return std::nullopt;
  const bool against = glm::dot(hit.normal, direction) < 0.0F;
  return heap::Meeting{true, *wall, hit.place, against ? hit.normal : -hit.normal};
}

heap::Finish ContentFacets::finish(std::uint32_t grain) const {
  const std::size_t object = objects_[grain];
  const scene::Material& material = object < instances() ? content_.instances()->group_of(object).source
                                                         : content_.draws()[object - instances()].look;
  return {static_cast<float>(material.roughness), material.specular, material.masking != scene::Masking::separable};
}

}  // namespace mesograin::render

// Rays go from grain to grain, through those that let them.
#include "heap/heap.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace mesograin::heap {
namespace {

// Through more grains nothing is followed.
constexpr int most_crossed = 4096;

// Of patches on walls, for a heap of few grains.
constexpr std::size_t fewest_nodes = 8000;

float mean(const glm::vec3& colour) { return (colour.r + colour.g + colour.b) / 3.0F; }

constexpr float far_away = std::numeric_limits<float>::infinity();

// Where a ray no longer meets a pane's surface that it has met, or not yet.
constexpr float rounding = 4e-6F;

float clearance(const PaneSurface& met, const glm::vec3& origin) {
  return rounding * (met.distance + std::max({std::abs(origin.x), std::abs(origin.y), std::abs(origin.z)}));
}

float beyond(const PaneSurface& met, const glm::vec3& origin) { return met.distance + clearance(met, origin); }

float before(const PaneSurface& met, const glm::vec3& origin) {
  return std::max(met.distance - clearance(met, origin), 0.0F);
}

}  // namespace

std::vector<Kind> kinds_of(const std::vector<Optics>& of, int most_walks, const transport::Effort& effort) {
  // What one kind's table is too bright another's is too dark, the more so the more there are.
  constexpr std::size_t few = 8;
  constexpr std::size_t most_shares = 8;  // of most_walks, an outcome is a walk then
  const std::size_t shares = std::bit_floor(std::clamp(of.size() / few, std::size_t{1}, most_shares));
  const int walks = most_walks / static_cast<int>(shares);
  std::vector<Kind> kinds;
  double done = 0.0;
  for (const Optics& optics : of) {
    const double next = done + 1.0 / static_cast<double>(of.size());
    const transport::Effort part = transport::part_of(effort, done, next);
    const std::size_t number = kinds.size();
    kinds.push_back({grain_table(optics, Sense::from_light, part, walks, number),
                     grain_table(optics, Sense::from_viewer, part, walks, number)});
    done = next;
  }
  return kinds;
}

Patches patches_about(const Grains& grains) { return {grains, fewest_nodes + grains.grains.size() / 4}; }

Space::Space(const Grains& grains, const std::vector<Kind>& kinds, std::shared_ptr<const Seats> seats)
    : Space(grains, kinds, std::move(seats), patches_about(grains), std::nullopt) {}

Space::Space(const Grains& grains, const std::vector<Kind>& kinds, std::shared_ptr<const Seats> seats, Patches patches,
             const std::optional<Neighbourhood>& neighbourhood)
    : grains_(grains.grains),
      walls_(grains.walls),
      panes_(grains.panes),
      kinds_(kinds),
      seats_(seats ? std::move(seats) : std::make_shared<const Seats>(grains.grains.size())),
      patches_(std::move(patches)),
      neighbourhood_(neighbourhood ? *neighbourhood : Neighbourhood(grains)) {}

bool Space::is_open(std::uint32_t grain, float far) const {
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        if (x == 0 && y == 0 && z == 0) continue;
        const glm::vec3 direction = glm::normalize(glm::vec3(x, y, z));
        const glm::vec3 from = place(grains_[grain], direction);
        const std::optional<Meeting> meeting = neighbourhood_.first(from, direction);
        if (!meeting || glm::distance(from, meeting->place) > far) return true;
      }
  return false;
}

bool any_clear(const std::vector<Kind>& kinds) {
  return std::any_of(kinds.begin(), kinds.end(), [](const Kind& kind) { return kind.from_light->is_clear(); });
}

bool any_turbid(const std::vector<Kind>& kinds) {
  return std::any_of(kinds.begin(), kinds.end(), [](const Kind& kind) { return kind.from_light->is_turbid(); });
}

WallPlace Space::place(const Patches::Node& node, float u, float v) const {
  // As the node's share of the light falls off.
  const auto tent = [](float at) {
    return at < 0.5F ? std::sqrt(2.0F * at) - 1.0F : 1.0F - std::sqrt(2.0F - 2.0F * at);
  };
  const int axis = node.side / 2;
  const float length = patches_.length(node.level);
  glm::vec3 facing(0.0F);
  facing[axis] = node.side % 2 == 0 ? 1.0F : -1.0F;
  glm::vec3 near(0.0F);
  near[axis] = node.depth;
  near[(axis + 1) % 3] = length * (static_cast<float>(node.at.x) + tent(u));
  near[(axis + 2) % 3] = length * (static_cast<float>(node.at.y) + tent(v));
  const float before = 2.0F * length;
  // A part of what a node stands for may lie beside the wall.
  for (const glm::vec3& from : {near, node.home})
    if (const std::optional<Meeting> meeting =
            neighbourhood_.first_on(node.wall, patches_.middle() + from + before * facing, -facing, 2.0F * before))
      return {meeting->place + 1e-4F * length * meeting->normal, meeting->normal};
  return {patches_.middle() + node.home + 1e-4F * length * facing, facing};
}

glm::vec3 Space::this_side(const glm::vec3& from, const glm::vec3& to) const {
  const float way = glm::distance(from, to);
  if (walls_.empty() || !(way > 0.0F)) return to;
  const glm::vec3 direction = (to - from) / way;
  const std::optional<Meeting> wall = neighbourhood_.first_wall(from, direction, way);
  return wall ? wall->place - 1e-4F * way * direction : to;
}

void Space::cross(Ray& ray, const Meeting& meeting, float cosine) const {
  const Grain& grain = grains_[meeting.number];
  ray.origin = place(grain, meeting.normal + 2.0F * cosine * ray.direction);
  ray.crossed = true;
  ray.from = nobody;
}

std::optional<Source> Space::source(const Meeting& meeting, Ray& ray, transport::Random& random) const {
  ray.origin = meeting.place;
  if (!meeting.wall) {
    const GrainTable& table = *kind(meeting.number).from_light;
    return Source{meeting.number, table.seen_place(meeting.normal, -ray.direction), table.met(), meeting.normal};
  }
  const std::optional<std::uint32_t> node = patches_.draw(meeting.number, meeting.place, meeting.normal, random);
  if (!node) {
    ray.weight = glm::vec3(0.0F);
    return std::nullopt;
  }
  return Source{static_cast<std::uint32_t>(grains_.size()) + *node, glm::vec3(0.0F), glm::vec3(1.0F), meeting.normal};
}

glm::vec3 Space::passed_panes(const glm::vec3& origin, const glm::vec3& direction, float reach, bool mirrored) const {
  glm::vec3 left(1.0F);
  float near = 0.0F;
  for (int crossed = 0; !panes_.empty() && crossed < most_crossed; ++crossed) {
    const std::optional<PaneSurface> met = neighbourhood_.first_pane(origin, direction, near, reach);
    if (!met) return left;
    near = beyond(*met, origin);
    if (!met->met_from_outside(direction)) continue;
    const std::optional<PaneSurface> other = neighbourhood_.first_pane(origin, direction, near, reach);
    if (!other) return left;
    const Sheet glass =
        sheet(panes_[met->pane].glass, -glm::dot(met->normal, direction), other->distance - met->distance);
    left *= mirrored ? glass.left() : glass.passed;
    near = beyond(*other, origin);
  }
  return left;
}

bool Space::meets_pane(Ray& ray, float far, transport::Random& random) const {
  if (panes_.empty()) return false;
  const std::optional<PaneSurface> met = neighbourhood_.first_pane(ray.origin, ray.direction, 0.0F, far);
  if (!met) return false;
  float onwards = beyond(*met, ray.origin);
  if (met->met_from_outside(ray.direction))
    if (const std::optional<PaneSurface> other = neighbourhood_.first_pane(ray.origin, ray.direction, onwards, far)) {
      const float cosine = -glm::dot(met->normal, ray.direction);
      const Sheet glass = sheet(panes_[met->pane].glass, cosine, other->distance - met->distance);
      const float share = mean(glass.reflected) / std::max(mean(glass.left()), std::numeric_limits<float>::min());
      if (random.uniform() < share) {
        ray.origin += before(*met, ray.origin) * ray.direction;
        ray.direction += 2.0F * cosine * met->normal;
        ray.weight *= glass.reflected / share;
        ray.crossed = true;
        return true;
      }
      ray.weight *= glass.passed / (1.0F - share);
      onwards = beyond(*other, ray.origin);
    }
  ray.origin += onwards * ray.direction;
  return true;
}

std::optional<Source> Space::follow(Ray& ray, transport::Random& random) const {
  for (int crossed = 0; crossed < most_crossed; ++crossed) {
    const std::optional<Meeting> meeting = neighbourhood_.first(ray.origin, ray.direction, ray.from);
    const float far = meeting ? glm::distance(ray.origin, meeting->place) : far_away;
    if (meets_pane(ray, far, random)) continue;
    if (!meeting) return std::nullopt;
    if (meeting->wall) return source(*meeting, ray, random);
    const float cosine = std::clamp(-glm::dot(meeting->normal, ray.direction), 0.0F, 1.0F);
    const glm::vec3 crossing = kind(meeting->number).from_light->crossing(cosine);
    const glm::vec3 passed = ray.weight * crossing;
    const float all = mean(ray.weight);
    const float share = all > 0.0F ? mean(passed) / all : 0.0F;
    if (!(share > 0.0F)) return source(*meeting, ray, random);
    if (share < 1.0F && random.uniform() >= share) {
      ray.weight = (ray.weight - passed) / (1.0F - share);
      return source(*meeting, ray, random);
    }
    ray.weight = passed / share;
    cross(ray, *meeting, cosine);
  }
  ray.weight = glm::vec3(0.0F);
  return std::nullopt;
}

glm::vec3 Space::seen_along(Ray& ray, const Field& sent, transport::Random& random, const Crossed& crossed) const {
  constexpr float nothing = 1e-3F;
  glm::vec3 seen(0.0F);
  for (int along = 0; along < most_crossed; ++along) {
    if (std::max({ray.weight.r, ray.weight.g, ray.weight.b}) < nothing) break;
    const std::optional<Meeting> meeting = neighbourhood_.first(ray.origin, ray.direction, ray.from);
    ray.weight *=
        passed_panes(ray.origin, ray.direction, meeting ? glm::distance(ray.origin, meeting->place) : far_away, true);
    if (!meeting) return seen;
    const float cosine = std::clamp(-glm::dot(meeting->normal, ray.direction), 0.0F, 1.0F);
    if (const std::optional<glm::vec3> known = crossed && !meeting->wall ? crossed(*meeting, ray) : std::nullopt) {
      ray.weight *= *known;
      cross(ray, *meeting, cosine);
      continue;
    }
    const std::optional<Source> from = source(*meeting, ray, random);
    if (!from) break;
    const glm::vec3 crossing = meeting->wall ? glm::vec3(0.0F) : kind(meeting->number).from_light->crossing(cosine);
    seen += ray.weight * (1.0F - crossing) / from->met * seats_->light_at(sent, from->number, from->normal, true);
    if (meeting->wall) seen += ray.weight * walls_[meeting->number].radiance;
    ray.weight *= crossing;
    if (!meeting->wall) cross(ray, *meeting, cosine);
  }
  ray.weight = glm::vec3(0.0F);
  return seen;
}

glm::vec3 Space::passed(Ray& ray, float reach) const {
  constexpr float nothing = 1e-5F;
  const glm::vec3 start = ray.origin;
  glm::vec3 left(1.0F);
  for (int crossed = 0; crossed < most_crossed; ++crossed) {
    const std::optional<Meeting> meeting = neighbourhood_.first(ray.origin, ray.direction, ray.from);
    if (!meeting || glm::distance(start, meeting->place) > reach)
      return left * passed_panes(start, ray.direction, reach, false);
    if (meeting->wall) break;
    const float cosine = std::clamp(-glm::dot(meeting->normal, ray.direction), 0.0F, 1.0F);
    left *= kind(meeting->number).from_light->crossing(cosine);
    cross(ray, *meeting, cosine);
    if (std::max({left.r, left.g, left.b}) < nothing) break;
  }
  return glm::vec3(0.0F);
}

}  // namespace mesograin::heap

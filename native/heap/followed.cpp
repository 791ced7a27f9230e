// What is seen of a grain where nothing refracts at its surface: walks that ask for the lights on their way, in its
// ball or through its own facets, and end at what others send.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "heap/asking.h"
#include "heap/gather.h"
#include "heap/medium_walk.h"
#include "heap/spread.h"
#include "transport/directions.h"

namespace mesograin::heap {
namespace {

// At each of a walk's places a ray finds how much comes of no more lights than these: that takes out two fifths of
// their noise at three mean free paths to the radius, three fifths at ten, and costs a quarter to a half of the time.
constexpr std::size_t most_followed_out = 2;

// Of light through a grain that is told.
constexpr float much_crosses = 0.1F;

/// Which way a place of a grain that is no ball faces as light has it that has been scattered in the grain: as its
/// facet does and as it lies from the middle (docs/heaps.md, "Grains of a few pixels").
glm::vec3 told_normal(const glm::vec3& place, const glm::vec3& normal) {
  const float far = glm::length(place);
  return far > 0.0F ? glm::normalize(normal + place / far) : normal;
}

float mean(const glm::vec3& colour) { return (colour.r + colour.g + colour.b) / 3.0F; }

float largest(const glm::vec3& colour) { return std::max({colour.r, colour.g, colour.b}); }

}  // namespace

bool Gather::sees_all(std::uint32_t grain) const {
  const Surface surface = heap_.grains.kinds[space_.grains()[grain].kind].surface;
  return surface == Surface::index_matched || surface == Surface::lambert_lambert;
}

void Gather::show_what_is_behind(const Ray& through, All& all) const {
  all.world = through.weight * glm::vec3(lights::radiance(seen_by_camera_, glm::dvec3(through.direction)));
  if (heap_.world.film_transparent) all.film = mean(through.weight);
}

std::vector<Asking> Gather::asking(std::uint32_t grain, transport::Random& random) const {
  std::vector<Asking> asking;
  asking.reserve(draws_.size());
  const Grain& of = space_.grains()[grain];
  for (const Draw& draw : draws_) {
    const double u = random.uniform();
    asking.emplace_back(draw, glm::dvec2(u, random.uniform()), heap_.anchor, of.middle, of.radius);
  }
  return asking;
}

Gather::All Gather::walked_in(std::uint32_t grain, const glm::vec3& place, const glm::vec3& normal,
                              const glm::vec3& towards, const Walks& walks, transport::Random& random) const {
  // What leaves a facet goes on from where it is, not from the one point of the sphere that faces as it does.
  const glm::vec3 aside = place - space_.grains()[grain].radius * normal;
  const Grain& seen = space_.grains()[grain];
  const glm::vec3 middle = seen.middle + aside;
  const Optics& optics = heap_.grains.kinds[seen.kind];
  const float mu = std::clamp(glm::dot(normal, towards), 0.0F, 1.0F);
  const TurnedFrame frame(normal, -towards);
  All all;
  for (int i = 0; i < walks.number; ++i) {
    std::vector<Asking> asking = this->asking(grain, random);
    const auto ask = [&](const glm::vec3& at, const glm::vec3& direction, const glm::vec3& weight) {
      const glm::vec3 in_frame = frame * at;
      for (Asking& of : asking) {
        of.move_to(middle + seen.radius * in_frame);
        const float along = glm::dot(in_frame, of.to_light());
        const float out = -along + std::sqrt(std::max(along * along + 1.0F - glm::dot(at, at), 0.0F));
        const float chord = std::min(out, of.reach() / seen.radius);
        of.ask(of.scattered(static_cast<float>(optics.g), frame * direction, weight) *
                   glm::exp(-glm::vec3(optics.sigma_t) * chord),
               glm::normalize(in_frame + out * of.to_light()), seen.radius * out, random);
      }
    };
    const std::optional<Outcome> outcome =
        walk(optics, Sense::from_viewer, mu, random, optics.transparent() ? Scattered(ask) : Scattered());
    for (Asking& of : asking) {
      if (outcome && !optics.transparent()) {
        const glm::vec3 leaves_at = frame * outcome->normal;
        of.move_to(middle + seen.radius * leaves_at);
        of.ask(of.reflected(leaves_at, outcome->weight), leaves_at, 0.0F, random);
      }
      if (!of.any()) continue;
      const Asking::Chosen& chosen = of.chosen();
      Ray ray{space_.place(seen, chosen.place) + aside, chosen.to_light, glm::vec3(1.0F), false, grain};
      all.scattered += of.asked() * space_.passed(ray, chosen.reach);
    }
    if (!outcome) continue;
    const glm::vec3 leaves_at =
        space_.this_side(seen.middle + place, space_.place(seen, frame * outcome->normal) + aside);
    Ray ray{leaves_at, frame * outcome->direction, outcome->weight, false, grain};
    if (const std::optional<glm::vec3> sent = seen_of_others(ray, walks.further, random))
      all.others += *sent;
    else
      all.scattered += even_world(ray);
  }
  all.others /= static_cast<float>(walks.number);
  all.scattered /= static_cast<float>(walks.number);
  return all;
}

bool Gather::is_walked_once_more(std::uint32_t number) const {
  return number < space_.grains().size() && sees_all(number) && !is_lambert(number) &&
         (ways_ == Ways::whole || !is_walked_behind(number));
}

glm::vec3 Gather::walked_in(const Source& source, const Ray& ray, int further, transport::Random& random) const {
  const Grain& grain = space_.grains()[source.number];
  const glm::vec3& normal = source.facing;
  const float mu = std::clamp(-glm::dot(normal, ray.direction), 0.0F, 1.0F);
  // What does not go straight through it is in the ray's weight as in the walk's.
  const glm::vec3 met = 1.0F - space_.kind(source.number).from_light->crossing(mu);
  const All all = walked_in(source.number, grain.radius * normal, normal, -ray.direction, {1, further}, random);
  return ray.weight / glm::max(met, 1e-6F) * (all.others + all.scattered);
}

Gather::All Gather::look_at_all(std::uint32_t grain, const glm::vec3& place, const glm::vec3& normal,
                                const glm::vec3& towards, const Walks& walks, transport::Random& random) const {
  All all = walked_in(grain, place, normal, towards, walks, random);
  Ray through = ray_through(grain, normal, towards);
  Behind behind;
  const auto crossed = [&](const Meeting& meeting, const Ray& ray) -> std::optional<glm::vec3> {
    if (!is_walked_behind(meeting.number)) return std::nullopt;
    const float mu = std::clamp(-glm::dot(meeting.normal, ray.direction), 0.0F, 1.0F);
    const Optics& optics = heap_.grains.kinds[space_.grains()[meeting.number].kind];
    const glm::vec3 crossing = glm::exp(-2.0F * mu * glm::vec3(optics.sigma_t));
    behind.add({meeting.number, meeting.place, meeting.normal, -ray.direction}, std::nullopt, ray.weight, crossing,
               random);
    return crossing;
  };
  all.met = 1.0F - through.weight;
  all.straight = space_.seen_along(through, light_->sent, random, crossed);
  all.others += all.straight;
  if (const int more = behind.walks(walks.number, random)) {
    const SeenFacet& there = behind.seen;
    const glm::vec3 from_middle = space_.grains()[there.grain].radius * there.normal;
    behind.show(walked_in(there.grain, from_middle, there.normal, there.towards, {more, walks.further}, random), all);
  }
  all.others = glm::max(all.others, 0.0F);
  show_what_is_behind(through, all);
  return all;
}

Gather::All Gather::look_at_told(std::uint32_t grain, const glm::vec3& place, const glm::vec3& normal,
                                 const glm::vec3& towards, transport::Random& random) const {
  All all;
  const GrainTable& table = *space_.answering(grain).from_light;
  const glm::vec3 faces = told_normal(place, normal);
  const float mu = std::clamp(glm::dot(faces, towards), 0.0F, 1.0F);
  const glm::vec3 sent = light_->seats->light_at(light_->sent, grain, table.seen_place(faces, towards), true);
  all.scattered = table.lobe_at(mu) * glm::max(sent, 0.0F);
  Ray through = ray_through(grain, faces, towards);
  all.met = 1.0F - through.weight;
  // Where little crosses it, few looks see it for all.
  const float share = std::min(largest(through.weight) / much_crosses, 1.0F);
  if (share < 1.0F && random.uniform() >= share) return all;
  through.weight /= share;
  all.straight = all.others = glm::max(space_.seen_along(through, light_->sent, random), 0.0F);
  show_what_is_behind(through, all);
  return all;
}

Gather::Straight Gather::look_straight(std::uint32_t grain, const glm::vec3& normal, const glm::vec3& towards,
                                       transport::Random& random) const {
  const GrainTable& table = *space_.answering(grain).from_light;
  const float mu = std::clamp(glm::dot(normal, towards), 0.0F, 1.0F);
  const glm::vec3 answer = light_->seats->light_at(light_->answer, grain, table.seen_place(normal, towards), true);
  Ray through = ray_through(grain, normal, towards);
  const float crosses = mean(through.weight);
  const glm::vec3 straight = glm::max(space_.seen_along(through, light_->sent, random), 0.0F);
  const float open = crosses > 0.0F ? std::clamp(mean(through.weight) / crosses, 0.0F, 1.0F) : 0.0F;
  return {table.lobe_at(mu) * glm::max(answer, 0.0F), straight, open};
}

void Gather::Behind::add(const SeenFacet& facet, const std::optional<End>& its_end, const glm::vec3& comes,
                         const glm::vec3& crosses, transport::Random& random) {
  const float share = mean(comes * (1.0F - crosses));
  if (!(share > 0.0F)) return;
  met += share;
  if (random.uniform() * met >= share) return;
  seen = facet;
  across = its_end;
  weight = comes / share;
}

int Gather::Behind::walks(int before, transport::Random& random) {
  if (!(met > 0.0F)) return 0;
  const float wanted = met * static_cast<float>(before);
  if (wanted >= 1.0F) return static_cast<int>(std::lround(wanted));
  if (random.uniform() >= wanted) return 0;
  weight /= wanted;
  return 1;
}

void Gather::Behind::show(const All& found, All& all) const {
  all.others += met * weight * found.others;
  all.scattered += met * weight * found.scattered;
}

glm::vec3 Gather::left_across(const Optics& optics, std::uint32_t grain, const std::optional<End>& end) const {
  if (!optics.transparent()) return glm::vec3(0.0F);
  const float radii = (end ? end->distance : 0.0F) / space_.grains()[grain].radius_of_kind();
  return glm::exp(-radii * glm::vec3(optics.sigma_t));
}

glm::vec3 Gather::left_across_seen(std::uint32_t grain, const std::optional<End>& end) const {
  return left_across(heap_.grains.kinds[space_.grains()[grain].kind], grain, end);
}

glm::vec3 Gather::left_across_other(std::uint32_t grain, const std::optional<End>& end) const {
  return left_across(of_others_[space_.grains()[grain].kind], grain, end);
}

std::optional<End> Gather::end_across(std::uint32_t grain, const glm::vec3& place, const glm::vec3& direction,
                                      const Facets& facets) const {
  return is_transparent(grain) ? facets.end(grain, place, direction) : std::nullopt;
}

std::optional<Gather::WayOut> Gather::way_out(std::uint32_t grain, const glm::vec3& place, const glm::vec3& direction,
                                              float reach, const Facets& facets) const {
  std::optional<End> end = facets.end(grain, place, direction);
  if (end && end->distance >= reach) end = End{reach, false};
  if (end && end->wall) return std::nullopt;
  const float distance = end ? end->distance : 0.0F;
  return WayOut{place + distance * direction, distance, left_across_seen(grain, end)};
}

bool Gather::is_transparent(std::uint32_t grain) const {
  return heap_.grains.kinds[space_.grains()[grain].kind].transparent();
}

glm::vec3 Gather::passed_between(std::uint32_t grain, glm::vec3 place, const glm::vec3& to_light, float reach,
                                 const Facets& facets) const {
  const glm::vec3 start = place;
  glm::vec3 left(1.0F);
  for (int crossed = 0; crossed < most_crossed; ++crossed) {
    const std::optional<Meeting> meeting = beyond_panes(grain, place, to_light, false, facets, left);
    if (!meeting || glm::distance(start, meeting->place) >= reach) return left;
    if (meeting->wall) break;
    const std::optional<End> end = end_across(meeting->number, meeting->place, to_light, facets);
    left *= left_across_other(meeting->number, end);
    if ((end && end->wall) || largest(left) < nothing) break;
    grain = meeting->number;
    place = meeting->place + (end ? end->distance : 0.0F) * to_light;
  }
  return glm::vec3(0.0F);
}

glm::vec3 Gather::sent_by(const Meeting& meeting, Ray& ray, transport::Random& random) const {
  const std::optional<Source> source = space_.source(meeting, ray, random);
  return source ? told_by(*source, ray) : glm::vec3(0.0F);
}

glm::vec3 Gather::sent_by_facet(const Meeting& meeting, const Facets& facets, int further, const Hero& hero,
                                transport::Random& random) const {
  const std::uint32_t kind =
      meeting.wall ? heap_.grains.walls[meeting.number].kind : space_.grains()[meeting.number].kind;
  const glm::vec3 reflectance(heap_.grains.kinds[kind].reflectance);
  const std::uint32_t from = meeting.wall ? nobody : meeting.number;
  glm::vec3 irradiance(0.0F);
  for (const Draw& draw : draws_) {
    const double u = random.uniform();
    const lights::LightDraw light = draw(heap_.anchor + glm::dvec3(meeting.place), {u, random.uniform()});
    const glm::vec3 to_light(light.to_light);
    const float cosine = glm::dot(to_light, meeting.normal);
    if (!(cosine > 0.0F)) continue;
    const auto reach = static_cast<float>(std::min(light.reach, 1e30));
    irradiance += cosine * glm::vec3(light.irradiance) * passed_between(from, meeting.place, to_light, reach, facets);
  }
  const float u = random.uniform();
  Ray ray{meeting.place, transport::cosine_lobe(meeting.normal, u, random.uniform()), reflectance};
  const glm::vec3 others = followed_on(from, std::nullopt, false, ray, facets, further, hero, random);
  return reflectance * irradiance / std::numbers::pi_v<float> + others + even_world(ray);
}

bool Gather::is_walked_behind(std::uint32_t grain) const {
  const std::uint32_t kind = space_.grains()[grain].kind;
  return is_transparent(grain) && of_others_[kind].g != heap_.grains.kinds[kind].g;
}

glm::vec3 Gather::seen_between(std::uint32_t grain, std::optional<Meeting> wall, Crossings crossings, Ray& ray,
                               const Facets& facets, transport::Random& random, Behind* behind, int further) const {
  glm::vec3 seen(0.0F);
  for (int crossed = 0; crossed < most_crossed && largest(ray.weight) >= nothing; ++crossed) {
    const std::optional<Meeting> meeting =
        wall ? wall : beyond_panes(grain, ray.origin, ray.direction, true, facets, ray.weight);
    if (!meeting) return seen;
    Ray here = ray;
    if (meeting->wall) {
      ray.weight = glm::vec3(0.0F);
      if (crossings == Crossings::all) seen += here.weight * heap_.grains.walls[meeting->number].radiance;
      return seen + sent_by(*meeting, here, random);
    }
    grain = meeting->number;
    const std::optional<End> end = end_across(grain, meeting->place, ray.direction, facets);
    const bool walked = behind && is_walked_behind(grain);
    const glm::vec3 crossing = walked ? left_across_seen(grain, end) : left_across_other(grain, end);
    float share = 1.0F;  // of the rays that cross it
    if (walked) {
      behind->add({grain, meeting->place, meeting->normal, -ray.direction}, end, ray.weight, crossing, random);
    } else if (crossings == Crossings::drawn) {
      share = mean(ray.weight * crossing) / mean(ray.weight);
      if (random.uniform() >= share) {
        here.weight = ray.weight / (1.0F - share);
        ray.weight = glm::vec3(0.0F);
        if (further > 0 && is_walked_once_more(grain) && (end || !is_transparent(grain))) {
          const SeenFacet there{grain, meeting->place, meeting->normal, -ray.direction};
          const All all = walked_in(there, end, facets, {1, further - 1}, random);
          return here.weight * (all.others + all.scattered);
        }
        here.weight *= 1.0F - crossing;
        if (further > 0 && is_lambert(grain))
          return here.weight * sent_by_lambert(grain, meeting->normal, further - 1, random);
        return sent_by(*meeting, here, random);
      }
    } else {
      here.weight = ray.weight * (1.0F - crossing);
      seen += sent_by(*meeting, here, random);
    }
    ray.weight *= crossing / share;
    ray.origin = meeting->place + (end ? end->distance : 0.0F) * ray.direction;
    wall = end && end->wall ? facets.inside(grain, meeting->place, ray.direction) : std::nullopt;
  }
  ray.weight = glm::vec3(0.0F);
  return seen;
}

// Chance goes by one channel on all of the way: no channel then counts more than three times as much as the way is
// likely.
glm::vec3 Gather::followed_on(std::uint32_t grain, std::optional<Meeting> wall, bool sees_what_shines, Ray& ray,
                              const Facets& facets, int further, Hero hero, transport::Random& random) const {
  hero.choose(random);
  for (int crossed = 0; crossed < most_crossed && largest(ray.weight) >= nothing; ++crossed) {
    const std::optional<Meeting> meeting =
        wall ? wall : beyond_panes(grain, ray.origin, ray.direction, true, facets, ray.weight);
    if (!meeting) return glm::vec3(0.0F);
    Ray here = ray;
    if (meeting->wall) {
      ray.weight = glm::vec3(0.0F);
      const glm::vec3 shines = sees_what_shines ? heap_.grains.walls[meeting->number].radiance : glm::vec3(0.0F);
      const glm::vec3 shown = here.weight * shines;
      if (further > 0) return shown + here.weight * sent_by_facet(*meeting, facets, further - 1, hero, random);
      return shown + sent_by(*meeting, here, random);
    }
    grain = meeting->number;
    const std::optional<End> end = end_across(grain, meeting->place, ray.direction, facets);
    const glm::vec3 crossing = left_across_other(grain, end);
    if (random.uniform() >= crossing[hero.channel]) {
      ray.weight = glm::vec3(0.0F);
      hero.weigh(here.weight, glm::vec3(1.0F), 1.0F - crossing);
      if (further > 0 && is_walked_once_more(grain) && (end || !is_transparent(grain))) {
        const SeenFacet there{grain, meeting->place, meeting->normal, -ray.direction};
        const All all = walked_in(there, end, facets, {1, further - 1}, random, hero);
        return here.weight * (all.others + all.scattered);
      }
      here.weight *= 1.0F - crossing;
      if (further > 0 && is_lambert(grain))
        return here.weight * sent_by_facet(*meeting, facets, further - 1, hero, random);
      return sent_by(*meeting, here, random);
    }
    hero.weigh(ray.weight, crossing, crossing);
    ray.origin = meeting->place + (end ? end->distance : 0.0F) * ray.direction;
    wall = end && end->wall ? facets.inside(grain, meeting->place, ray.direction) : std::nullopt;
  }
  ray.weight = glm::vec3(0.0F);
  return glm::vec3(0.0F);
}

Gather::All Gather::walked_in(const SeenFacet& seen, const std::optional<End>& across, const Facets& facets,
                              const Walks& walks, transport::Random& random, const Hero& hero) const {
  const Grain& grain = space_.grains()[seen.grain];
  const Optics& optics = heap_.grains.kinds[grain.kind];
  const bool transparent = optics.transparent();
  All all;
  for (int i = 0; i < walks.number; ++i) {
    std::vector<Asking> asking = this->asking(seen.grain, random);
    const bool followed_out = transparent && asking.size() <= most_followed_out;
    const auto ask = [&](const glm::vec3& at, const glm::vec3& direction, const glm::vec3& weight) {
      for (Asking& of : asking) {
        of.move_to(at);
        const glm::vec3 light = of.scattered(static_cast<float>(optics.g), direction, weight);
        if (!followed_out)
          of.ask(light, at, 0.0F, random);
        else if (const std::optional<WayOut> out = way_out(seen.grain, at, of.to_light(), of.reach(), facets))
          of.ask(out->left * light, out->place, out->distance, random);
      }
    };
    Hero carried = hero;
    const std::optional<Passage> passage = walk_medium(optics, grain.radius_of_kind(), seen, across, facets, random,
                                                       transparent ? Scattered(ask) : Scattered(), &carried);
    for (Asking& of : asking) {
      if (passage && !transparent) {
        of.move_to(passage->place);
        of.ask(of.reflected(passage->normal, passage->weight), passage->place, 0.0F, random);
      }
      if (!of.any()) continue;
      const Asking::Chosen& from = of.chosen();
      std::optional<WayOut> out = WayOut{from.place, 0.0F, glm::vec3(1.0F)};
      if (transparent && !followed_out) out = way_out(seen.grain, from.place, from.to_light, from.reach, facets);
      if (!out) continue;
      all.scattered += of.asked() * out->left *
                       passed_between(seen.grain, out->place, from.to_light, from.reach - out->distance, facets);
    }
    if (!passage) continue;
    Ray ray{passage->place, passage->direction, passage->weight};
    if (ways_ == Ways::whole)
      all.others += followed_on(seen.grain, passage->wall, false, ray, facets, walks.further, carried, random);
    else
      all.others +=
          seen_between(seen.grain, passage->wall, Crossings::drawn, ray, facets, random, nullptr, walks.further);
    all.scattered += even_world(ray);
  }
  all.others /= static_cast<float>(walks.number);
  all.scattered /= static_cast<float>(walks.number);
  return all;
}

std::optional<Gather::All> Gather::look_at_all(const SeenFacet& seen, const Facets& facets, const Walks& walks,
                                               transport::Random& random) const {
  Ray through{};
  std::optional<All> all = look_at_all_but_world(seen, facets, walks, random, through);
  if (all) show_what_is_behind(through, *all);
  return all;
}

std::optional<Gather::All> Gather::look_at_all_but_world(const SeenFacet& seen, const Facets& facets,
                                                         const Walks& walks, transport::Random& random,
                                                         Ray& through) const {
  const std::optional<End> across = end_across(seen.grain, seen.place, -seen.towards, facets);
  if (is_transparent(seen.grain) && !across) return std::nullopt;
  All all = walked_in(seen, across, facets, walks, random);
  through = {seen.place - (across ? across->distance : 0.0F) * seen.towards, -seen.towards,
             left_across_seen(seen.grain, across)};
  const std::optional<Meeting> wall =
      across && across->wall ? facets.inside(seen.grain, seen.place, -seen.towards) : std::nullopt;
  Behind behind;
  all.met = 1.0F - through.weight;
  all.straight = ways_ == Ways::whole
                     ? followed_on(seen.grain, wall, true, through, facets, walks.further, Hero{}, random)
                     : seen_between(seen.grain, wall, Crossings::all, through, facets, random, &behind);
  all.others += all.straight;
  if (const int more = behind.walks(walks.number, random))
    behind.show(walked_in(behind.seen, behind.across, facets, {more, walks.further}, random), all);
  all.others = glm::max(all.others, 0.0F);
  return all;
}

}  // namespace mesograin::heap

// What is seen of a grain where nothing refracts at its surface: walks that ask for the lights on their way, in its
// ball or through its own facets, and end at what others send.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include "heap/asking.h"
#include "heap/gather.h"
#include "heap/medium_walk.h"
#include "heap/spread.h"

namespace mesograin::heap {
namespace {

// Light that is scattered so far forwards, or backwards, is followed through grains behind the one that is seen.
constexpr double least_forward = 0.6;
constexpr double most_followed_on = 12.0;

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
  const glm::dvec3 middle = heap_.anchor + glm::dvec3(space_.grains()[grain].middle);
  for (const Draw& draw : draws_) {
    const float u = random.uniform();
    asking.emplace_back(draw(middle, {u, random.uniform()}));
  }
  return asking;
}

int Gather::followed_on(std::uint32_t grain) const {
  const Optics& optics = heap_.grains.kinds[space_.grains()[grain].kind];
  if (!optics.transparent() || std::abs(optics.g) < least_forward) return 0;
  // After n scatterings exp(-n (1 - g)) is left of a direction, or nearly, and a mean chord is 4/3 of the radius.
  const double scatterings = 4.0 / 3.0 * std::max({optics.sigma_t.r, optics.sigma_t.g, optics.sigma_t.b});
  return static_cast<int>(std::min(2.0 / ((1.0 - std::abs(optics.g)) * scatterings), most_followed_on - 1.0)) + 1;
}

void Gather::add_walk(const SeenBall& seen, const glm::vec3& share, int on, transport::Random& random, All& all) const {
  const Grain& grain = space_.grains()[seen.grain];
  const Optics& optics = heap_.grains.kinds[grain.kind];
  // What leaves a facet goes on from where it is, not from the one point of the sphere that faces as it does.
  const glm::vec3 aside = seen.place - grain.radius * seen.normal;
  const float mu = std::clamp(glm::dot(seen.normal, seen.towards), 0.0F, 1.0F);
  const TurnedFrame frame(seen.normal, -seen.towards);
  std::vector<Asking> asking = this->asking(seen.grain, random);
  const auto ask = [&](const glm::vec3& at, const glm::vec3& direction, const glm::vec3& weight) {
    const glm::vec3 in_frame = frame * at;
    for (Asking& of : asking) {
      const float along = glm::dot(in_frame, of.to_light());
      const float chord = -along + std::sqrt(std::max(along * along + 1.0F - glm::dot(at, at), 0.0F));
      of.ask(of.scattered(static_cast<float>(optics.g), frame * direction, share * weight) *
                 glm::exp(-glm::vec3(optics.sigma_t) * chord),
             glm::normalize(in_frame + chord * of.to_light()), random);
    }
  };
  const std::optional<Outcome> outcome =
      walk(optics, Sense::from_viewer, mu, random, optics.transparent() ? Scattered(ask) : Scattered());
  for (Asking& of : asking) {
    if (outcome && !optics.transparent()) {
      const glm::vec3 leaves_at = frame * outcome->normal;
      of.ask(of.reflected(leaves_at, share * outcome->weight), leaves_at, random);
    }
    if (!of.any()) continue;
    Ray ray{space_.place(grain, of.place()) + aside, of.to_light(), glm::vec3(1.0F)};
    all.scattered += of.asked() * space_.passed(ray, of.reach());
  }
  if (!outcome) return;
  const glm::vec3 leaves_at =
      space_.this_side(grain.middle + seen.place, space_.place(grain, frame * outcome->normal) + aside);
  Ray ray{leaves_at, frame * outcome->direction, share * outcome->weight};
  if (on > 0) {
    const std::optional<Source> source = space_.follow(ray, random);
    if (!source) {
      all.scattered += even_world(ray);
    } else if (source->number < space_.grains().size() && is_lit(source->number)) {
      const glm::vec3 facing = glm::normalize(ray.origin - space_.grains()[source->number].middle);
      const float cosine = std::clamp(-glm::dot(facing, ray.direction), 0.0F, 1.0F);
      // What does not go straight through it is in the ray's weight as in the walk's.
      const glm::vec3 met = 1.0F - space_.kind(source->number).from_light->crossing(cosine);
      add_walk({source->number, space_.grains()[source->number].radius * facing, facing, -ray.direction},
               ray.weight / glm::max(met, 1e-6F), on - 1, random, all);
    } else {
      all.others +=
          ray.weight / source->met * light_->seats->light_at(light_->sent, source->number, source->normal, true);
    }
  } else if (const std::optional<glm::vec3> sent = sent_along(ray, random)) {
    all.others += *sent;
  } else {
    all.scattered += even_world(ray);
  }
}

Gather::All Gather::look_at_all(std::uint32_t grain, const glm::vec3& place, const glm::vec3& normal,
                                const glm::vec3& towards, int rays, transport::Random& random) const {
  All all;
  for (int i = 0; i < rays; ++i)
    add_walk({grain, place, normal, towards}, glm::vec3(1.0F), followed_on(grain), random, all);
  all.others /= static_cast<float>(rays);
  all.scattered /= static_cast<float>(rays);
  Ray through = ray_through(grain, normal, towards);
  all.others = glm::max(all.others + space_.seen_along(through, light_->sent, random), 0.0F);
  show_what_is_behind(through, all);
  return all;
}

glm::vec3 Gather::sigma_t(std::uint32_t grain) const {
  const Grain& of = space_.grains()[grain];
  return glm::vec3(heap_.grains.kinds[of.kind].sigma_t) / of.radius_of_kind();
}

glm::vec3 Gather::left_across(std::uint32_t grain, const std::optional<End>& end) const {
  if (!is_transparent(grain)) return glm::vec3(0.0F);
  return glm::exp(-(end ? end->distance : 0.0F) * sigma_t(grain));
}

std::optional<End> Gather::end_across(std::uint32_t grain, const glm::vec3& place, const glm::vec3& direction,
                                      const Facets& facets) const {
  return is_transparent(grain) ? facets.end(grain, place, direction) : std::nullopt;
}

bool Gather::is_transparent(std::uint32_t grain) const {
  return heap_.grains.kinds[space_.grains()[grain].kind].transparent();
}

glm::vec3 Gather::passed_between(std::uint32_t grain, glm::vec3 place, const glm::vec3& to_light, float reach,
                                 const Facets& facets) const {
  const glm::vec3 start = place;
  glm::vec3 left(1.0F);
  for (int crossed = 0; crossed < most_crossed; ++crossed) {
    const std::optional<Meeting> meeting = facets.beyond(grain, place, to_light);
    if (!meeting || glm::distance(start, meeting->place) >= reach) return left;
    if (meeting->wall) break;
    const std::optional<End> end = end_across(meeting->number, meeting->place, to_light, facets);
    left *= left_across(meeting->number, end);
    if ((end && end->wall) || largest(left) < nothing) break;
    grain = meeting->number;
    place = meeting->place + (end ? end->distance : 0.0F) * to_light;
  }
  return glm::vec3(0.0F);
}

glm::vec3 Gather::sent_by(const Meeting& meeting, Ray& ray, transport::Random& random) const {
  const std::optional<Source> source = space_.source(meeting, ray, random);
  if (!source) return glm::vec3(0.0F);
  return ray.weight / source->met * light_->seats->light_at(light_->sent, source->number, source->normal, true);
}

glm::vec3 Gather::seen_between(std::uint32_t grain, std::optional<Meeting> wall, Crossings crossings, Ray& ray,
                               const Facets& facets, transport::Random& random) const {
  glm::vec3 seen(0.0F);
  for (int crossed = 0; crossed < most_crossed && largest(ray.weight) >= nothing; ++crossed) {
    const std::optional<Meeting> meeting = wall ? wall : facets.beyond(grain, ray.origin, ray.direction);
    if (!meeting) return seen;
    Ray here = ray;
    if (meeting->wall) {
      ray.weight = glm::vec3(0.0F);
      if (crossings == Crossings::all) seen += here.weight * heap_.grains.walls[meeting->number].radiance;
      return seen + sent_by(*meeting, here, random);
    }
    grain = meeting->number;
    const std::optional<End> end = end_across(grain, meeting->place, ray.direction, facets);
    const glm::vec3 crossing = left_across(grain, end);
    float share = 1.0F;  // of the rays that cross it
    if (crossings == Crossings::drawn) {
      share = mean(ray.weight * crossing) / mean(ray.weight);
      if (random.uniform() >= share) {
        here.weight = ray.weight * (1.0F - crossing) / (1.0F - share);
        ray.weight = glm::vec3(0.0F);
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

void Gather::add_walk(const SeenFacet& seen, const std::optional<End>& across, const Facets& facets,
                      const glm::vec3& share, int on, transport::Random& random, All& all) const {
  const Grain& grain = space_.grains()[seen.grain];
  const Optics& optics = heap_.grains.kinds[grain.kind];
  const bool transparent = optics.transparent();
  std::vector<Asking> asking = this->asking(seen.grain, random);
  const auto ask = [&](const glm::vec3& at, const glm::vec3& direction, const glm::vec3& weight) {
    for (Asking& of : asking) of.ask(of.scattered(static_cast<float>(optics.g), direction, share * weight), at, random);
  };
  const std::optional<Passage> passage = walk_medium(optics, grain.radius_of_kind(), seen, across, facets, random,
                                                     transparent ? Scattered(ask) : Scattered());
  for (Asking& of : asking) {
    if (passage && !transparent) of.ask(of.reflected(passage->normal, share * passage->weight), passage->place, random);
    if (!of.any()) continue;
    glm::vec3 leaves_at = of.place();
    glm::vec3 left(1.0F);
    if (transparent) {
      const std::optional<End> end = facets.end(seen.grain, leaves_at, of.to_light());
      if (end && end->wall) continue;
      left = left_across(seen.grain, end);
      if (end) leaves_at += end->distance * of.to_light();
    }
    all.scattered += of.asked() * left * passed_between(seen.grain, leaves_at, of.to_light(), of.reach(), facets);
  }
  if (!passage) return;
  Ray ray{passage->place, passage->direction, share * passage->weight};
  if (on > 0) {
    follow_on(seen.grain, passage->wall, ray, facets, on, random, all);
  } else {
    all.others += seen_between(seen.grain, passage->wall, Crossings::drawn, ray, facets, random);
    all.scattered += even_world(ray);
  }
}

void Gather::follow_on(std::uint32_t grain, std::optional<Meeting> wall, Ray ray, const Facets& facets, int on,
                       transport::Random& random, All& all) const {
  for (int crossed = 0; crossed < most_crossed && largest(ray.weight) >= nothing; ++crossed) {
    const std::optional<Meeting> meeting = wall ? wall : facets.beyond(grain, ray.origin, ray.direction);
    if (!meeting) {
      all.scattered += even_world(ray);
      return;
    }
    if (meeting->wall || !is_lit(meeting->number)) {
      all.others += sent_by(*meeting, ray, random);
      return;
    }
    grain = meeting->number;
    const std::optional<End> end = end_across(grain, meeting->place, ray.direction, facets);
    const glm::vec3 crossing = left_across(grain, end);
    const float share = mean(ray.weight * crossing) / mean(ray.weight);
    if (random.uniform() >= share) {
      const SeenFacet seen{grain, meeting->place, meeting->normal, -ray.direction};
      if (is_transparent(grain) && !end) return;
      add_walk(seen, end, facets, ray.weight / (1.0F - share), on - 1, random, all);
      return;
    }
    ray.weight *= crossing / share;
    ray.origin = meeting->place + (end ? end->distance : 0.0F) * ray.direction;
    wall = end && end->wall ? facets.inside(grain, meeting->place, ray.direction) : std::nullopt;
  }
}

std::optional<Gather::All> Gather::look_at_all(const SeenFacet& seen, const Facets& facets, int rays,
                                               transport::Random& random) const {
  const std::optional<End> across = end_across(seen.grain, seen.place, -seen.towards, facets);
  if (is_transparent(seen.grain) && !across) return std::nullopt;
  All all;
  for (int i = 0; i < rays; ++i) add_walk(seen, across, facets, glm::vec3(1.0F), followed_on(seen.grain), random, all);
  all.others /= static_cast<float>(rays);
  all.scattered /= static_cast<float>(rays);
  Ray through{seen.place - (across ? across->distance : 0.0F) * seen.towards, -seen.towards,
              left_across(seen.grain, across)};
  const std::optional<Meeting> wall =
      across && across->wall ? facets.inside(seen.grain, seen.place, -seen.towards) : std::nullopt;
  all.others += seen_between(seen.grain, wall, Crossings::all, through, facets, random);
  all.others = glm::max(all.others, 0.0F);
  show_what_is_behind(through, all);
  return all;
}

}  // namespace mesograin::heap

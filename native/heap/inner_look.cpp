// What is seen of a grain whose inner light is known: of what lights do there first a few places of the view ray tell,
// and the polynomial all that comes after. And how it becomes known.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <vector>

#include "heap/asking.h"
#include "heap/gather.h"
#include "heap/medium_walk.h"
#include "transport/directions.h"

namespace mesograin::heap {
namespace {

// Places of a view ray, for each channel, at which the polynomial is asked.
constexpr int nodes = 4;

// And the lights are, for all.
constexpr int lit_places = 2;

/// The way of a view ray through a grain, whose channels are scattered at places of their own.
class Chord {
 public:
  Chord(const glm::vec3& sigma_t, float length)
      : length_(length), sigma_t_(glm::max(sigma_t, glm::vec3(1e-6F / std::max(length, 1e-30F)))) {
    for (int channel = 0; channel < 3; ++channel) within_[channel] = -std::expm1(-sigma_t_[channel] * length);
  }

  float length() const { return length_; }

  /// How much of each is scattered or absorbed.
  const glm::vec3& within() const { return within_; }

  /// Where one of them is, `u` uniform in [0, 1).
  float distance(float u, int channel) const {
    const float sigma_t = sigma_t_[channel];
    // So few mean free paths that their exponential is a straight line.
    const float flight = sigma_t * length_ > 1e-3F ? -std::log1p(-u * within_[channel]) / sigma_t : u * length_;
    return std::min(flight, length_);
  }

  /// How much is there, over how likely the place is if each channel draws as often (Wilkie et al. 2014, eq. 6).
  glm::vec3 met(float distance) const {
    const glm::vec3 there = sigma_t_ * glm::exp(-sigma_t_ * distance);
    const glm::vec3 density = there / within_;
    return there * (3.0F / (density.r + density.g + density.b));
  }

 private:
  float length_;
  glm::vec3 sigma_t_;
  glm::vec3 within_{0.0F};
};

bool tells(const Optics& optics) {
  constexpr double thickest = 8.0;
  return optics.transparent() && optics.followed() && optics.g == 0.0 &&
         std::max({optics.sigma_t.r, optics.sigma_t.g, optics.sigma_t.b}) <= thickest;
}

}  // namespace

bool Gather::tells_inner_light(std::uint32_t grain) const { return tells(optics(grain)); }

bool Gather::tells_any_inner_light() const {
  return std::any_of(heap_.grains.kinds.begin(), heap_.grains.kinds.end(), tells);
}

void Gather::learn(std::uint32_t number, const Facets& facets, int walks, transport::Random& random,
                   InnerLight& light) const {
  const Grain& grain = space_.grains()[number];
  const Optics& optics = this->optics(number);
  struct Scattering {
    glm::vec3 place;
    glm::vec3 weight;
    glm::vec3 lit;
  };
  std::vector<Scattering> scatterings;
  for (int i = 0; i < walks; ++i) {
    light.count();
    const float u = random.uniform();
    const glm::vec3 outwards = transport::isotropic(u, random.uniform());
    const std::optional<End> surface = facets.end(number, grain.middle, outwards);
    if (!surface || surface->wall) continue;
    const float v = random.uniform();
    const glm::vec3 inwards = -transport::cosine_lobe(outwards, v, random.uniform());
    const SeenFacet seen{number, grain.middle + surface->distance * outwards, outwards, -inwards};
    const std::optional<End> across = facets.end(number, seen.place, inwards);
    if (!across) continue;
    std::vector<Asking> asking = this->asking(number, random);
    scatterings.clear();
    const auto told = [&](const glm::vec3& at, const glm::vec3& direction, const glm::vec3& weight) {
      glm::vec3 lit(0.0F);
      // What lights do at the first is seen without it.
      if (!scatterings.empty())
        for (Asking& of : asking) {
          of.move_to(at);
          if (const std::optional<WayOut> out = way_out(number, at, of.to_light(), of.reach(), facets))
            lit += out->left * of.scattered(static_cast<float>(optics.g), direction, weight) *
                   passed_between(number, out->place, of.to_light(), of.reach() - out->distance, facets);
        }
      scatterings.push_back({(at - grain.middle) / grain.radius, weight, lit});
    };
    glm::vec3 found(0.0F);
    if (const std::optional<Passage> passage =
            walk_medium(optics, grain.radius_of_kind(), seen, across, facets, random, told)) {
      Ray ray{passage->place, passage->direction, passage->weight};
      found = seen_between(number, passage->wall, Crossings::drawn, ray, facets, random);
      found += even_world(ray);
    }
    for (std::size_t at = scatterings.size(); at-- > 0;) {
      light.add(scatterings[at].place, scatterings[at].weight, found);
      found += scatterings[at].lit;
    }
  }
}

Gather::All Gather::seen_in(const SeenFacet& seen, const End& across, const InnerLight& light, const Facets& facets,
                            transport::Random& random) const {
  const Grain& grain = space_.grains()[seen.grain];
  const Optics& optics = this->optics(seen.grain);
  const Chord chord(glm::vec3(optics.sigma_t) / grain.radius_of_kind(), across.distance);
  const glm::vec3 albedo(optics.albedo);
  const auto from_middle = [&](float distance) {
    return (seen.place - distance * seen.towards - grain.middle) / grain.radius;
  };
  All all;
  const InnerLight::Line line = light.along(from_middle(0.0F), from_middle(chord.length()));
  for (int i = 0; i < nodes; ++i)
    for (int channel = 0; channel < 3; ++channel) {
      const float distance = chord.distance((static_cast<float>(i) + 0.5F) / nodes, channel);
      all.steady[channel] += line.at(distance / std::max(chord.length(), 1e-30F), channel);
    }
  all.steady *= albedo * chord.within() / static_cast<float>(nodes);
  std::vector<Asking> asking = this->asking(seen.grain, random);
  for (int i = 0; i < lit_places; ++i) {
    const int channel = std::min(static_cast<int>(3.0F * random.uniform()), 2);
    const float distance = chord.distance((static_cast<float>(i) + random.uniform()) / lit_places, channel);
    const glm::vec3 at = seen.place - distance * seen.towards;
    const glm::vec3 weight = albedo * chord.met(distance);
    for (Asking& of : asking) {
      of.move_to(at);
      if (const std::optional<WayOut> out = way_out(seen.grain, at, of.to_light(), of.reach(), facets))
        of.ask(out->left * of.scattered(static_cast<float>(optics.g), -seen.towards, weight), out->place, out->distance,
               random);
    }
  }
  for (const Asking& of : asking)
    if (of.any())
      all.scattered +=
          of.asked() * passed_between(seen.grain, of.chosen().place, of.chosen().to_light, of.chosen().reach, facets);
  all.scattered /= static_cast<float>(lit_places);
  return all;
}

std::optional<Gather::All> Gather::look_at_all(const SeenFacet& seen, const Facets& facets, const InnerLight& light,
                                               transport::Random& random) const {
  const std::optional<End> across = end_across(seen.grain, seen.place, -seen.towards, facets);
  if (!across || across->wall) return std::nullopt;
  All all = seen_in(seen, *across, light, facets, random);
  Ray through{seen.place - across->distance * seen.towards, -seen.towards, left_across_seen(seen.grain, across)};
  all.met = 1.0F - through.weight;
  all.straight = glm::max(seen_between(seen.grain, std::nullopt, Crossings::all, through, facets, random), 0.0F);
  all.others = all.straight;
  show_what_is_behind(through, all);
  return all;
}

}  // namespace mesograin::heap

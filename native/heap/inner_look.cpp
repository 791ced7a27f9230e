// What is seen of a grain whose inner light is known: of what lights do there first a few places of the view ray tell,
// and the polynomial all that comes after. And how it becomes known.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "heap/asking.h"
#include "heap/gather.h"
#include "heap/medium_walk.h"
#include "transport/directions.h"

namespace mesograin::heap {
namespace {

// Places of a view ray at which the polynomial is asked.
constexpr int nodes = 4;

// At which the lights are.
constexpr int lit_places = 2;

/// Of a chord: places that are spread as the light of the channel with the longest ways is scattered there.
class Places {
 public:
  Places(const glm::vec3& sigma_t, float chord)
      : sigma_t_(sigma_t),
        least_(std::max(std::min({sigma_t.r, sigma_t.g, sigma_t.b}), 1e-3F / std::max(chord, 1e-30F))),
        within_(-std::expm1(-least_ * chord)) {}

  float distance(float u) const { return -std::log1p(-u * within_) / least_; }

  /// How much of the light is scattered or absorbed there, over how likely the place is.
  glm::vec3 met(float distance) const { return sigma_t_ * glm::exp((least_ - sigma_t_) * distance) * within_ / least_; }

 private:
  glm::vec3 sigma_t_;
  float least_;
  float within_;
};

}  // namespace

bool Gather::tells_inner_light(std::uint32_t grain) const {
  constexpr double thickest = 8.0;
  const Optics& optics = this->optics(grain);
  return optics.transparent() && optics.followed() && optics.g == 0.0 &&
         std::max({optics.sigma_t.r, optics.sigma_t.g, optics.sigma_t.b}) <= thickest;
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
    const std::vector<Asking> asking = this->asking(number, random);
    scatterings.clear();
    const auto told = [&](const glm::vec3& at, const glm::vec3& direction, const glm::vec3& weight) {
      glm::vec3 lit(0.0F);
      // What lights do at the first is seen without it.
      if (!scatterings.empty())
        for (const Asking& of : asking)
          if (const std::optional<WayOut> out = way_out(number, at, of.to_light(), facets))
            lit += out->left * of.scattered(static_cast<float>(optics.g), direction, weight) *
                   passed_between(number, out->place, of.to_light(), of.reach(), facets);
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
  const Places places(glm::vec3(optics.sigma_t) / grain.radius_of_kind(), across.distance);
  const glm::vec3 albedo(optics.albedo);
  All all;
  for (int i = 0; i < nodes; ++i) {
    const float distance = places.distance((static_cast<float>(i) + 0.5F) / nodes);
    const glm::vec3 at = (seen.place - distance * seen.towards - grain.middle) / grain.radius;
    all.steady += albedo * places.met(distance) * light.at(at);
  }
  all.steady /= static_cast<float>(nodes);
  std::vector<Asking> asking = this->asking(seen.grain, random);
  for (int i = 0; i < lit_places; ++i) {
    const float distance = places.distance((static_cast<float>(i) + random.uniform()) / lit_places);
    const glm::vec3 at = seen.place - distance * seen.towards;
    const glm::vec3 weight = albedo * places.met(distance);
    for (Asking& of : asking)
      if (const std::optional<WayOut> out = way_out(seen.grain, at, of.to_light(), facets))
        of.ask(out->left * of.scattered(static_cast<float>(optics.g), -seen.towards, weight), out->place, random);
  }
  for (const Asking& of : asking)
    if (of.any())
      all.scattered += of.asked() * passed_between(seen.grain, of.place(), of.to_light(), of.reach(), facets);
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

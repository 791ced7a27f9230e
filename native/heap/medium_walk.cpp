// Flights from scattering to scattering, and to facets, where light leaves.
#include "heap/medium_walk.h"

#include <glm/geometric.hpp>

#include "transport/directions.h"

namespace mesograin::heap {
namespace {

// Light that is scattered for ever is given up.
constexpr int most_steps = 1 << 16;

}  // namespace

std::optional<Passage> walk_medium(const Optics& optics, float radius, const SeenFacet& seen,
                                   const std::optional<End>& across, const Facets& facets, transport::Random& random,
                                   const Scattered& scattered, Hero* hero) {
  const auto lobe = [&](const glm::vec3& normal) {
    const float u = random.uniform();
    return transport::cosine_lobe(normal, u, random.uniform());
  };
  if (optics.surface == Surface::lambert)
    return Passage{seen.place, lobe(seen.normal), glm::vec3(optics.reflectance), false, false, {}, 0.0F,
                   false,      seen.normal};
  Flights flights(glm::vec3(optics.sigma_t) / radius, glm::vec3(optics.albedo), random,
                  hero != nullptr ? *hero : Hero{});
  const bool transparent = optics.transparent();
  Passage passage{seen.place, transparent ? -seen.towards : -lobe(seen.normal), glm::vec3(1.0F), true, false};
  for (int step = 0; step < most_steps; ++step) {
    const bool straight = transparent && step == 0;
    const std::optional<End> end = straight ? across : facets.end(seen.grain, passage.place, passage.direction);
    // Where no facet is met, it ends.
    const float chord = end ? end->distance : 0.0F;
    const float flight = straight ? flights.fly_within(chord) : flights.fly(chord);
    passage.weight = flights.weight();
    if (straight && passage.weight == glm::vec3(0.0F)) return std::nullopt;
    if (flight < chord) {
      passage.scattered = true;
      passage.place += flight * passage.direction;
      if (scattered) scattered(passage.place, passage.direction, passage.weight);
      passage.direction =
          transport::scattered(passage.direction, static_cast<float>(optics.g), random.uniform(), random.uniform());
      if (!flights.survives()) return std::nullopt;
      continue;
    }
    const bool has_wall = end && end->wall;
    const std::optional<Meeting> met =
        has_wall || !transparent ? facets.inside(seen.grain, passage.place, passage.direction) : std::nullopt;
    passage.place += chord * passage.direction;
    if (has_wall) {
      passage.wall = met;
    } else if (!transparent) {
      passage.normal = met ? met->normal : passage.direction;
      passage.direction = lobe(passage.normal);
    }
    if (hero != nullptr) *hero = flights.hero();
    return passage;
  }
  return std::nullopt;
}

}  // namespace mesograin::heap

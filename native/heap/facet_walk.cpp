// At each facet light is reflected or refracted as Fresnel has it, at a microfacet where the surface is rough.
#include "heap/facet_walk.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "heap/flights.h"
#include "heap/spread.h"
#include "physics/physics.h"
#include "physics/visible_normals.h"
#include "transport/directions.h"

namespace mesograin::heap {
namespace {

using transport::Random;

// Light that is totally reflected for ever is given up.
constexpr int most_facets = 256;

// Rougher than a mirror.
constexpr float least_alpha = 1e-3F;

glm::vec3 mirrored(const glm::vec3& direction, const glm::vec3& normal) {
  return glm::normalize(direction - 2.0F * glm::dot(direction, normal) * normal);
}

/// The normal of the microfacet that is met, on the side of `normal`.
glm::vec3 microfacet(const glm::vec3& normal, const glm::vec3& travelling, float alpha, Random& random) {
  if (alpha < least_alpha) return normal;
  const TurnedFrame frame(normal, -travelling);
  const double cosine = std::clamp(-static_cast<double>(glm::dot(travelling, normal)), 0.0, 1.0);
  const double radius = std::sqrt(static_cast<double>(random.uniform()));
  const double azimuth = 2.0 * std::numbers::pi * random.uniform();
  const glm::dvec3 facet =
      physics::visible_normal({std::sqrt((1.0 - cosine) * (1.0 + cosine)), 0.0, cosine}, alpha, radius, azimuth);
  return frame * glm::vec3(facet);
}

/// On beyond a facet, or back from it. `normal`: against what is travelling; `eta`: beyond it over before it.
/// What another microfacet would catch goes the way of a smooth surface.
bool enters(const glm::vec3& normal, float alpha, double eta, glm::vec3& travelling, Random& random) {
  const float choice = random.uniform();
  for (const glm::vec3& facet : {microfacet(normal, travelling, alpha, random), normal}) {
    const double cosine = std::clamp(-static_cast<double>(glm::dot(travelling, facet)), 0.0, 1.0);
    const bool reflected = choice < physics::fresnel_reflectance(cosine, eta);
    const glm::vec3 on =
        reflected ? mirrored(travelling, facet) : transport::refracted(travelling, facet, static_cast<float>(eta));
    if ((glm::dot(on, normal) > 0.0F) == reflected) {
      travelling = on;
      return !reflected;
    }
  }
  return true;
}

}  // namespace

std::optional<Passage> walk_facets(const Optics& optics, float radius, const SeenFacet& seen, const Facets& facets,
                                   Scatterings scatterings, Random& random, glm::vec3* first) {
  glm::vec3 place = seen.place;
  glm::vec3 direction = -seen.towards;
  const float alpha = facets.finish(seen.grain).roughness;
  if (!enters(seen.normal, alpha, optics.eta, direction, random))
    return Passage{place, direction, glm::vec3(1.0F), false, false};
  Flights flights(glm::vec3(optics.sigma_t) / radius, glm::vec3(optics.albedo), random);
  bool scattered = false;
  for (int met = 0; met < most_facets; ++met) {
    const std::optional<Meeting> facet = facets.inside(seen.grain, place, direction);
    if (!facet) return Passage{place, direction, flights.weight(), true, scattered};
    const float chord = glm::distance(place, facet->place);
    const float flight = flights.fly(chord);
    if (flight < chord) {
      if (!scattered && first != nullptr) *first = flights.weight();
      scattered = true;
      place += flight * direction;
      if (scatterings == Scatterings::end) return Passage{place, direction, flights.weight(), true, true};
      direction = transport::scattered(direction, static_cast<float>(optics.g), random.uniform(), random.uniform());
      if (!flights.survives()) return std::nullopt;
      continue;
    }
    place = facet->place;
    if (facet->wall) return Passage{place, direction, flights.weight(), true, scattered, facet};
    // Near an edge an interpolated normal may point away from light that comes out there.
    constexpr float least_cosine = 1e-4F;
    const float cosine = glm::dot(facet->normal, direction);
    const glm::vec3 inwards = -glm::normalize(facet->normal + std::max(least_cosine - cosine, 0.0F) * direction);
    if (enters(inwards, alpha, 1.0 / optics.eta, direction, random))
      return Passage{place, direction, flights.weight(), true, scattered};
    if (!flights.survives()) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace mesograin::heap

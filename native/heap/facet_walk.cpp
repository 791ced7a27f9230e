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

/// On beyond a facet, or back from it. `normal`: against what is travelling; `eta`: beyond it over before it.
bool enters_smooth(const glm::vec3& normal, double eta, glm::vec3& travelling, Random& random) {
  const double cosine = std::clamp(-static_cast<double>(glm::dot(travelling, normal)), 0.0, 1.0);
  const bool reflected = random.uniform() < physics::fresnel_reflectance(cosine, eta);
  travelling =
      reflected ? mirrored(travelling, normal) : transport::refracted(travelling, normal, static_cast<float>(eta));
  return !reflected;
}

/// A facet of GGX as it is seen from where a ray comes from: normals on the side of `up`.
glm::vec3 visible_facet(const glm::vec3& up, const glm::vec3& travelling, float alpha, Random& random) {
  const double cosine = std::clamp(-static_cast<double>(glm::dot(travelling, up)), -1.0, 1.0);
  const double radius = std::sqrt(static_cast<double>(random.uniform()));
  const double azimuth = 2.0 * std::numbers::pi * random.uniform();
  const glm::dvec3 facet =
      physics::visible_normal({std::sqrt((1.0 - cosine) * (1.0 + cosine)), 0.0, cosine}, alpha, radius, azimuth);
  return TurnedFrame(up, -travelling) * glm::vec3(facet);
}

/// How high over a rough surface a ray meets it next, as the share of it that lies below; nothing, if it leaves it.
/// `rise`: the ray's cosine with the way up. Heights are evenly spread (Heitz et al. 2016, section 4 and supplement,
/// sampleHeight).
std::optional<float> next_height(float height, float rise, float alpha, Random& random) {
  constexpr float upright = 0.9999F;
  constexpr float level = 1e-4F;
  const float u = random.uniform();
  if (rise > upright) return std::nullopt;
  if (rise < -upright) return u * height;
  if (std::abs(rise) < level) return height;
  // Smith's Lambda of GGX, below the horizon too (eq. 8 there).
  const float slope = alpha * std::sqrt((1.0F - rise) * (1.0F + rise)) / rise;
  const float lambda = 0.5F * (std::copysign(std::sqrt(1.0F + slope * slope), rise) - 1.0F);
  if (rise > 0.0F && u > 1.0F - std::pow(height, lambda)) return std::nullopt;
  return std::min(height / std::pow(1.0F - u, 1.0F / lambda), 1.0F);
}

/// As enters_smooth(), of a rough surface: from facet to facet until light leaves it to either side (Heitz, Hanika,
/// d'Eon and Dachsbacher, "Multiple-scattering microfacet BSDFs with the Smith model", 2016, algorithm 1), so that no
/// light is lost.
bool enters(const glm::vec3& normal, float alpha, double eta, glm::vec3& travelling, Random& random) {
  if (alpha < least_alpha) return enters_smooth(normal, eta, travelling, random);
  glm::vec3 on = travelling;
  bool before = true;  // the surface, as the ray came
  float height = 1.0F;
  for (int met = 0; met < most_facets; ++met) {
    const glm::vec3 up = before ? normal : -normal;
    const std::optional<float> next = next_height(height, glm::dot(on, up), alpha, random);
    if (!next) {
      travelling = glm::normalize(on);
      return !before;
    }
    height = *next;
    const bool crosses = enters_smooth(visible_facet(up, on, alpha, random), before ? eta : 1.0 / eta, on, random);
    if (!crosses) continue;
    before = !before;
    height = 1.0F - height;
  }
  return enters_smooth(normal, eta, travelling, random);
}

}  // namespace

std::optional<End> Facets::end(std::uint32_t grain, const glm::vec3& origin, const glm::vec3& direction) const {
  const std::optional<Meeting> met = inside(grain, origin, direction);
  if (!met) return std::nullopt;
  return End{glm::distance(origin, met->place), met->wall};
}

std::optional<Passage> walk_facets(const Optics& optics, float radius, const SeenFacet& seen, const Facets& facets,
                                   Scatterings scatterings, Random& random, const AtFacet& at_facet) {
  const glm::vec3 place = seen.place;
  glm::vec3 direction = -seen.towards;
  const float alpha = facets.finish(seen.grain).roughness;
  if (!enters(seen.normal, alpha, optics.eta, direction, random))
    return Passage{place, direction, glm::vec3(1.0F), false, false};
  Flights flights(glm::vec3(optics.sigma_t) / radius, glm::vec3(optics.albedo), random);
  Passage passage{place, direction, glm::vec3(1.0F), true, false};
  for (int met = 0; met < most_facets; ++met) {
    passage.weight = flights.weight();
    const std::optional<Meeting> facet = facets.inside(seen.grain, passage.place, passage.direction);
    if (!facet) return passage;
    const float chord = glm::distance(passage.place, facet->place);
    const float flight = flights.fly(chord);
    passage.weight = flights.weight();
    passage.length += std::min(flight, chord);
    if (flight < chord) {
      passage.scattered = true;
      passage.place += flight * passage.direction;
      if (scatterings == Scatterings::end) return passage;
      passage.direction =
          transport::scattered(passage.direction, static_cast<float>(optics.g), random.uniform(), random.uniform());
      if (!flights.survives()) return std::nullopt;
      continue;
    }
    passage.place = facet->place;
    passage.flat = facet->flat;
    if (facet->wall) {
      passage.wall = facet;
      return passage;
    }
    // Near an edge an interpolated normal may point away from light that comes out there.
    constexpr float least_cosine = 1e-4F;
    const float cosine = glm::dot(facet->normal, passage.direction);
    const glm::vec3 inwards =
        -glm::normalize(facet->normal + std::max(least_cosine - cosine, 0.0F) * passage.direction);
    if (at_facet) at_facet(passage, inwards);
    if (enters(inwards, alpha, 1.0 / optics.eta, passage.direction, random)) return passage;
    ++passage.reflected;
    if (!flights.survives()) return std::nullopt;
  }
  return std::nullopt;
}

double leaving_density(const glm::dvec3& normal, double alpha, double eta, const glm::dvec3& travelling,
                       const glm::dvec3& beyond) {
  const double mu = -glm::dot(normal, travelling), mu_beyond = -glm::dot(normal, beyond);
  if (!(mu > 0.0) || !(mu_beyond > 0.0)) return 0.0;
  const glm::dvec3 sum = eta * beyond - travelling;
  const double size = glm::length(sum);
  const glm::dvec3 facet = (glm::dot(sum, normal) < 0.0 ? -1.0 : 1.0) / size * sum;
  const double on_facet = -glm::dot(facet, travelling), on_facet_beyond = -glm::dot(facet, beyond);
  if (!(on_facet > 0.0) || !(on_facet_beyond > 0.0)) return 0.0;
  const double seen =
      2.0 * on_facet * physics::ggx_distribution(normal, facet, alpha) / (mu + physics::ggx_smith_root(mu, alpha));
  const double unshadowed = 2.0 * mu_beyond / (mu_beyond + physics::ggx_smith_root(mu_beyond, alpha));
  const double facets_a_steradian = eta * eta * on_facet_beyond / (size * size);
  return (1.0 - physics::fresnel_reflectance(on_facet, eta)) * seen * facets_a_steradian * unshadowed;
}

}  // namespace mesograin::heap

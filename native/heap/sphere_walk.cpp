// Flights to the sphere's other side, scatterings and what its surface reflects, until light is outside.
#include "heap/sphere_walk.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "heap/flights.h"
#include "physics/physics.h"
#include "physics/visible_normals.h"
#include "transport/directions.h"

namespace mesograin::heap {
namespace {

using transport::Random;

// Light that is totally reflected for ever is given up.
constexpr int most_steps = 1 << 16;

glm::vec3 cosine_lobe(const glm::vec3& normal, Random& random) {
  const float u = random.uniform();
  return transport::cosine_lobe(normal, u, random.uniform());
}

Outcome mirrored(const Optics& optics, const glm::vec3& travelling, Random& random) {
  const glm::dvec3 view(-travelling);
  const double alpha = std::max(optics.roughness, 1e-4);
  const double azimuth = 2.0 * std::numbers::pi * random.uniform();
  const glm::dvec3 facet = physics::visible_normal(glm::dvec3(-view.x, 0.0, view.z), alpha,
                                                   std::sqrt(static_cast<double>(random.uniform())), azimuth);
  const glm::vec3 normal(static_cast<float>(-facet.x), static_cast<float>(facet.y), static_cast<float>(facet.z));
  glm::vec3 direction = travelling - 2.0F * glm::dot(travelling, normal) * normal;
  // What a second facet would catch leaves along the surface.
  direction.z = std::max(direction.z, 1e-3F);
  return {{0.0F, 0.0F, 1.0F}, glm::normalize(direction), glm::vec3(optics.reflectance)};
}

/// A walk inside the unit sphere.
class Inside {
 public:
  Inside(const Optics& optics, Sense sense, Random& random, const Scattered& told)
      : optics_(optics),
        sense_(sense),
        random_(random),
        told_(told),
        flights_(glm::vec3(optics.sigma_t), glm::vec3(optics.albedo), random) {}

  std::optional<Outcome> follow(glm::vec3 place, glm::vec3 direction) {
    bool scattered = !optics_.transparent();
    for (int step = 0; step < most_steps; ++step) {
      const float along = glm::dot(place, direction);
      const float chord = -along + std::sqrt(std::max(along * along + 1.0F - glm::dot(place, place), 0.0F));
      const float flight = scattered ? flights_.fly(chord) : flights_.fly_within(chord);
      if (flight < chord) {
        scattered = met_ = true;
        place += flight * direction;
        if (told_) told_(place, direction, flights_.weight());
        direction =
            transport::scattered(direction, static_cast<float>(optics_.g), random_.uniform(), random_.uniform());
        if (!flights_.survives()) return std::nullopt;
        continue;
      }
      place = glm::normalize(place + chord * direction);
      if (std::optional<Outcome> outcome = leave(place, direction)) return outcome;
      if (done_) return std::nullopt;
    }
    return std::nullopt;
  }

 private:
  // Nothing where it is reflected inside, or where `done_`.
  std::optional<Outcome> leave(const glm::vec3& normal, glm::vec3& direction) {
    switch (optics_.surface) {
      case Surface::lambert_lambert:
        return Outcome{normal, cosine_lobe(normal, random_), flights_.weight()};
      case Surface::lambert_refracted: {
        if (sense_ == Sense::from_viewer) return Outcome{normal, cosine_lobe(normal, random_), flights_.weight()};
        // A view ray is refracted without Fresnel, and radiance is not focused: only what lies in its cone is seen.
        const auto eta = static_cast<float>(optics_.eta);
        const float cosine = glm::dot(normal, direction);
        if (eta * eta * (1.0F - cosine) * (1.0F + cosine) >= 1.0F) {
          done_ = true;
          return std::nullopt;
        }
        return Outcome{normal, transport::refracted(direction, -normal, 1.0F / eta), eta * eta * flights_.weight()};
      }
      case Surface::dielectric: {
        const float cosine = std::min(glm::dot(normal, direction), 1.0F);
        if (random_.uniform() < physics::fresnel_reflectance(cosine, 1.0 / optics_.eta)) {
          direction = glm::normalize(direction - 2.0F * cosine * normal);
          return std::nullopt;
        }
        return Outcome{normal, transport::refracted(direction, -normal, static_cast<float>(1.0 / optics_.eta)),
                       flights_.weight(), !met_, met_};
      }
      default:
        return Outcome{normal, direction, flights_.weight()};
    }
  }

  const Optics& optics_;
  Sense sense_;
  Random& random_;
  const Scattered& told_;
  Flights flights_;
  bool done_ = false;
  bool met_ = false;
};

}  // namespace

std::optional<Outcome> walk(const Optics& optics, Sense sense, float mu, Random& random, const Scattered& scattered) {
  const glm::vec3 normal(0.0F, 0.0F, 1.0F);
  const glm::vec3 travelling(std::sqrt(std::max(0.0F, (1.0F - mu) * (1.0F + mu))), 0.0F, -mu);
  const bool lambert_entry = optics.surface == Surface::lambert_lambert ||
                             (optics.surface == Surface::lambert_refracted && sense == Sense::from_light);
  switch (optics.surface) {
    case Surface::lambert:
      return Outcome{normal, cosine_lobe(normal, random), glm::vec3(optics.reflectance)};
    case Surface::mirror:
      return mirrored(optics, travelling, random);
    case Surface::dielectric:
      if (random.uniform() < physics::fresnel_reflectance(mu, optics.eta))
        return Outcome{normal, {travelling.x, 0.0F, mu}, glm::vec3(1.0F)};
      break;
    default:
      break;
  }
  Inside inside(optics, sense, random, scattered);
  if (lambert_entry) return inside.follow(normal, -cosine_lobe(normal, random));
  if (optics.eta != 1.0)
    return inside.follow(normal, transport::refracted(travelling, normal, static_cast<float>(optics.eta)));
  return inside.follow(normal, travelling);
}

}  // namespace mesograin::heap

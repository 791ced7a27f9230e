// One photon's random walk through a homogeneous body, from just inside its surface until it has left or lost its
// weight.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "directions.h"
#include "interface.h"
#include "rng.h"
#include "shapes.h"

namespace mesograin::referee {

struct Photon {
  glm::dvec3 position;
  glm::dvec3 direction;
  double weight = 1;
};

/// sigma_t is 1: every length is in mean free paths.
struct Medium {
  double albedo = 1;  ///< sigma_s / sigma_t; tables for many albedos walk at 1 and weigh by albedo^order afterwards
  double g = 0;
};

/// The visitor is told of every scattering, `scattered(position, direction before, order, weight)`, and of every part
/// of the weight that leaves, `left(position, normal, direction inside, order, weight)`; `order` counts the scatterings
/// so far. What is transmitted is tallied in expectation, and the walk goes on with the probability of reflection.
/// Weights are thinned by roulette, fairly: by half at every fourfold order (the orders of a conservative half-space
/// fall as n^-3/2, so this spends the same time on each octave), and wherever absorption has left little.
/// A walk is given up after `last_order` scatterings, where less than 1e-11 of the light is left at albedos up to
/// .9999.
template <class Shape, class Visitor>
void walk(const Shape& shape, const Interface& interface, const Medium& medium, Photon photon, Rng& rng,
          Visitor& visitor) {
  constexpr double least_weight = 0.05;
  constexpr int last_order = 1 << 18;
  int order = 0;
  int thinned_at = 16;
  while (true) {
    const glm::dvec3 next = photon.position - std::log(rng.uniform_positive()) * photon.direction;
    if (!shape.inside(next)) {
      photon.position += shape.distance_to_surface(photon.position, photon.direction) * photon.direction;
      const glm::dvec3 normal = shape.settle_on_surface(photon.position, photon.direction);
      const double cosine = glm::dot(normal, photon.direction);
      const double reflectance = interface.reflectance_from_inside(cosine);
      if (reflectance < 1) {
        visitor.left(photon.position, normal, photon.direction, order, photon.weight * (1 - reflectance));
        if (rng.uniform() >= reflectance) return;
      }
      photon.direction -= 2 * cosine * normal;
      continue;
    }
    photon.position = next;
    photon.weight *= medium.albedo;
    ++order;
    if (photon.weight < least_weight) {
      if (rng.uniform() * least_weight >= photon.weight) return;
      photon.weight = least_weight;
    }
    if (order == thinned_at) {
      if (order == last_order) return;
      thinned_at *= 4;
      if (rng.bits() & 1) return;
      photon.weight *= 2;
    }
    visitor.scattered(photon.position, photon.direction, order, photon.weight);
    photon.direction = sample_phase(photon.direction, medium.g, rng);
  }
}

}  // namespace mesograin::referee

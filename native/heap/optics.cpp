// From a material's numbers to those of a unit sphere.
#include "heap/optics.h"

#include <algorithm>
#include <cmath>
#include <glm/exponential.hpp>

namespace mesograin::heap {
namespace {

// Reduced mean free paths to the radius beyond which light leaves where it entered, as seen from another grain.
constexpr double thickest = 50.0;

// Mean free paths to the radius beyond which light has forgotten the phase function before it reaches another grain.
constexpr double most_flights = 150.0;

Surface surface_of(const scene::Material& material) {
  if (material.model == scene::Model::lambert) return Surface::lambert;
  if (material.model == scene::Model::conductor) return Surface::mirror;
  switch (material.boundary) {
    case scene::Boundary::dielectric:
      return material.eta == 1.0 ? Surface::index_matched : Surface::dielectric;
    case scene::Boundary::lambert_lambert:
      return Surface::lambert_lambert;
    case scene::Boundary::lambert_refracted:
      return Surface::lambert_refracted;
    default:
      return Surface::index_matched;
  }
}

/// 2 int (1 - e^(-2 sigma mu)) mu dmu from 0 to 1, of a sphere of radius 1 (van de Hulst, "Light Scattering by Small
/// Particles", 1957, section 11.22: the efficiency of geometric extinction).
double met_from_everywhere(double sigma_t) {
  const double depth = 2.0 * sigma_t;
  if (depth < 0.02) return depth * (2.0 / 3.0 - depth / 4.0 + depth * depth / 15.0);
  return 1.0 + 2.0 * (std::exp(-depth) * (depth + 1.0) - 1.0) / (depth * depth);
}

}  // namespace

glm::dvec3 Optics::met() const {
  if (!transparent()) return glm::dvec3(1.0);
  return {met_from_everywhere(sigma_t.r), met_from_everywhere(sigma_t.g), met_from_everywhere(sigma_t.b)};
}

bool Optics::followed() const {
  // Mean free paths to the radius: in thicker ones that costs more than the maps and shadows of a model. Between cosine
  // lobes the model is as near.
  constexpr double most = 20.0;
  return transparent() && std::max({sigma_t.r, sigma_t.g, sigma_t.b}) <= most;
}

bool Optics::clear() const {
  constexpr double least_crossing = 0.01;
  const double thinnest = std::min({sigma_t.r, sigma_t.g, sigma_t.b});
  return surface == Surface::dielectric && std::exp(-2.0 * thinnest) > least_crossing;
}

bool Optics::scatters_little() const {
  const glm::dvec3 scattered = albedo * (1.0 - glm::exp(-2.0 * sigma_t));
  return std::max({scattered.r, scattered.g, scattered.b}) < 0.5;
}

Optics optics_of(const scene::Material& material, double radius) {
  Optics optics;
  optics.surface = surface_of(material);
  if (optics.opaque()) {
    optics.reflectance = material.reflectance;
    if (optics.surface == Surface::mirror) optics.roughness = material.roughness;
    return optics;
  }
  const bool lobes = optics.surface == Surface::lambert_lambert || optics.surface == Surface::lambert_refracted;
  if (lobes) optics.reflectance = material.reflectance_to_others;
  optics.eta =
      optics.surface == Surface::dielectric || optics.surface == Surface::lambert_refracted ? material.eta : 1.0;
  optics.g = material.g;
  const double unit = material.scale * radius;
  const glm::dvec3 reduced = unit * (material.sigma_a + (1.0 - material.g) * material.sigma_s);
  const glm::dvec3 unreduced = unit * (material.sigma_a + material.sigma_s);
  const bool thick = std::max({reduced.r, reduced.g, reduced.b}) > thickest ||
                     std::max({unreduced.r, unreduced.g, unreduced.b}) > most_flights;
  // The medium that is similar and scatters isotropically (van de Hulst 1980, section 14.1.3).
  if (thick) optics.g = 0.0;
  for (int channel = 0; channel < 3; ++channel) {
    const double sigma_s = unit * (thick ? 1.0 - material.g : 1.0) * material.sigma_s[channel];
    const double sigma_t = unit * material.sigma_a[channel] + sigma_s;
    optics.sigma_t[channel] = thick ? std::min(sigma_t, thickest) : sigma_t;
    optics.albedo[channel] = sigma_t > 0.0 ? sigma_s / sigma_t : 0.0;
  }
  return optics;
}

Optics of_others(const Optics& optics) {
  if (optics.veiled()) {
    Optics veil;
    veil.reflectance = optics.reflectance;
    return veil;
  }
  if (!optics.transparent() || !(optics.g > 0.0)) return optics;
  Optics similar = optics;
  similar.g = 0.0;
  for (int channel = 0; channel < 3; ++channel) {
    const double sigma_s = (1.0 - optics.g) * optics.albedo[channel] * optics.sigma_t[channel];
    const double sigma_t = (1.0 - optics.albedo[channel]) * optics.sigma_t[channel] + sigma_s;
    similar.sigma_t[channel] = sigma_t;
    similar.albedo[channel] = sigma_t > 0.0 ? sigma_s / sigma_t : 0.0;
  }
  return similar;
}

Optics seen_among_others(const Optics& optics) { return optics.veiled() ? optics : of_others(optics); }

std::vector<Optics> of_others(std::vector<Optics> kinds) {
  for (Optics& optics : kinds) optics = of_others(optics);
  return kinds;
}

}  // namespace mesograin::heap

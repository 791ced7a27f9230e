// Traces the sun's rays through the sphere's plane of incidence and gathers them by cell and direction.
#include "reduced_light.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numbers>

#include "interface.h"
#include "rng.h"

namespace mesograin::referee {
namespace {

constexpr int shells = 256;                   // of depth
constexpr int sectors = 192;                  // of polar angle
constexpr int directions = 16;                // of the angle in the plane
constexpr int rays = 8192;                    // of impact parameter
constexpr double thickest_at_surface = 0.05;  // mean free paths
constexpr double faintest = 1e-7;             // of the mean ray's flux, still followed

struct Gathered {
  double flux = 0;  ///< times length
  glm::dvec2 direction{0};
};

}  // namespace

double ReducedLight::shell_depth(int shell) const {
  const double share = static_cast<double>(shell) / shells;
  return radius_ * (thinning_ > 0 ? std::expm1(thinning_ * share) / std::expm1(thinning_) : share);
}

std::size_t ReducedLight::cell(double rho, double z) const {
  const double depth = std::max(0.0, 1 - std::hypot(rho, z) / radius_);
  const double share = thinning_ > 0 ? std::log1p(depth * std::expm1(thinning_)) / thinning_ : depth;
  const int shell = std::min(static_cast<int>(share * shells), shells - 1);
  const int sector = std::min(static_cast<int>(std::atan2(rho, z) * (sectors / std::numbers::pi)), sectors - 1);
  return static_cast<std::size_t>(shell) * sectors + sector;
}

ReducedLight::ReducedLight(double radius, double eta) : radius_(radius) {
  while (shell_depth(1) > thickest_at_surface) thinning_ += 0.25;
  std::vector<Gathered> gathered(static_cast<std::size_t>(shells) * sectors * directions);
  const Interface interface { eta };
  const double longest_step = std::min(radius / 200, 0.1);
  Rng rng(1, 0);  // only jitters rays and steps
  for (int ray = 0; ray < rays; ++ray) {
    // Coordinates (x, z) in the plane of incidence; x changes sign where the ray crosses the axis.
    const double impact = (ray + rng.uniform()) / rays;
    if (impact >= eta) continue;  // totally reflected
    const double cosine = std::sqrt((1 - impact) * (1 + impact));
    const double reflectance = interface.reflectance_from_outside(cosine);
    glm::dvec2 position = radius * glm::dvec2(impact, cosine);
    const glm::dvec3 bent = refract({0, 0, -1}, glm::dvec3(impact, 0, cosine), eta);
    glm::dvec2 direction(bent.x, bent.z);
    const double chord = -2 * glm::dot(position, direction);
    const int steps = 1 + static_cast<int>(chord / longest_step);
    const double step = chord / steps;
    const double mean_flux = std::numbers::pi * radius * radius / rays;
    double flux = 2 * impact * mean_flux * (1 - reflectance);  // of the whole annulus, for unit irradiance
    while (flux > faintest * mean_flux) {
      const double offset = rng.uniform();
      for (int i = 0; i < steps; ++i) {
        const double along = (i + offset) * step;
        const double reached = flux * std::exp(-along);
        if (reached < faintest * mean_flux) break;
        const glm::dvec2 point = position + along * direction;
        const double side = point.x < 0 ? -1 : 1;
        const glm::dvec2 folded(side * direction.x, direction.y);
        const double angle = (std::atan2(folded.x, folded.y) / std::numbers::pi + 1) * 0.5 * directions;
        const int bin = std::min(static_cast<int>(angle), directions - 1);
        Gathered& sum = gathered[cell(side * point.x, point.y) * directions + bin];
        sum.flux += reached * step;
        sum.direction += reached * step * folded;
      }
      position += chord * direction;
      const glm::dvec2 normal = position / radius;
      direction -= 2 * glm::dot(direction, normal) * normal;
      flux *=
          std::exp(-chord) * reflectance;  // the angle inside is the same at every bounce, and so is the reflectance
    }
  }

  first_.push_back(0);
  for (int shell = 0; shell < shells; ++shell) {
    const double outer = radius - shell_depth(shell), inner = std::max(0.0, radius - shell_depth(shell + 1));
    for (int sector = 0; sector < sectors; ++sector) {
      const double polar = std::numbers::pi / sectors;
      const double volume = 2 * std::numbers::pi / 3 * (outer * outer * outer - inner * inner * inner) *
                            (std::cos(sector * polar) - std::cos((sector + 1) * polar));
      for (int bin = 0; bin < directions; ++bin) {
        const Gathered& sum = gathered[(static_cast<std::size_t>(shell) * sectors + sector) * directions + bin];
        if (sum.flux == 0) continue;
        const glm::dvec2 toward = glm::normalize(sum.direction);
        beams_.push_back({toward.x, toward.y, sum.flux / volume});
      }
      first_.push_back(beams_.size());
    }
  }
}

std::span<const ReducedLight::Beam> ReducedLight::beams(double rho, double z) const {
  const std::size_t index = cell(rho, z);
  return {beams_.data() + first_[index], first_[index + 1] - first_[index]};
}

}  // namespace mesograin::referee

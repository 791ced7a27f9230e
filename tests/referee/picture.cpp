// Backward walks from each pixel; at every scattering the unscattered sunlight that crosses the point is gathered.
#include "picture.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>

#include "base/error.h"
#include "mesh_picture.h"
#include "pixels.h"
#include "reduced_light.h"
#include "view.h"
#include "walk.h"

namespace mesograin::referee {
namespace {

using scene::Boundary;

void check(const PictureCase& setup) {
  const scene::Material& material = setup.material;
  if (!(std::abs(material.g) < 1)) throw Error("The referee needs g inside (-1, 1); got {}.", material.g);
  if (setup.mesh) return;
  if (material.boundary == Boundary::dielectric && material.roughness > 0)
    throw Error("The referee's sphere is smooth: roughness must be 0; got {}.", material.roughness);
  if (!(setup.radius > 0)) throw Error("The sphere's radius must be positive; got {}.", setup.radius);
  if (glm::distance(view_ray(setup.clip_to_world, 0, 0).origin, setup.centre) <= setup.radius)
    throw Error("The camera must stand outside the sphere, its near plane too; move it away.");
}

/// One channel's sphere, its lengths in mean free paths.
struct Grain {
  static constexpr double thinnest = 1e-6;  // mean free paths; nothing to be seen, but lengths to reckon with

  double radius, albedo, eta, g;
  Boundary boundary;
  std::optional<ReducedLight> reduced_light;  ///< only behind an interface that bends light

  Grain(const PictureCase& setup, int channel)
      : eta(setup.material.eta), g(setup.material.g), boundary(setup.material.boundary) {
    const double sigma_s = setup.material.sigma_s[channel], sigma_t = sigma_s + setup.material.sigma_a[channel];
    radius = std::max(thinnest, setup.radius * setup.material.scale * sigma_t);
    albedo = sigma_t > 0 ? sigma_s / sigma_t : 0;
    if (boundary == Boundary::dielectric && eta != 1) reduced_light.emplace(radius, eta);
  }

  bool lambert_entry() const {
    return boundary == Boundary::lambert_lambert || boundary == Boundary::lambert_refracted;
  }
  Interface interface() const { return {boundary == Boundary::dielectric ? eta : 1}; }
};

/// Gathers the light of every sun along one backward walk.
struct Gatherer {
  const Grain& grain;
  std::span<const glm::dvec3> to_light;  ///< this path's direction to each sun
  std::span<double> radiance;            ///< per unit irradiance of each sun

  void scattered(const glm::dvec3& position, const glm::dvec3& direction, int, double weight) {
    if (grain.lambert_entry()) return;
    for (std::size_t sun = 0; sun < to_light.size(); ++sun)
      radiance[sun] += weight * gather(position, direction, to_light[sun]);
  }

  void left(const glm::dvec3&, const glm::dvec3& normal, const glm::dvec3&, int, double weight) {
    if (!grain.lambert_entry()) return;
    for (std::size_t sun = 0; sun < to_light.size(); ++sun)
      radiance[sun] += weight * std::max(0.0, glm::dot(normal, to_light[sun])) / std::numbers::pi;
  }

  /// Phase function times fluence of the unscattered light at a point; `direction` is the backward walk's, against the
  /// light's.
  double gather(const glm::dvec3& position, const glm::dvec3& direction, const glm::dvec3& sun) const {
    if (!grain.reduced_light) {
      const double path = Sphere{grain.radius}.distance_to_surface(position, sun);
      return std::exp(-path) * phase(glm::dot(direction, sun), grain.g);
    }
    const double z = glm::dot(position, sun);
    const glm::dvec3 away = position - z * sun;
    const double rho = glm::length(away);
    const glm::dvec3 outward = rho > 0 ? away / rho : glm::dvec3(0);
    double sum = 0;
    for (const ReducedLight::Beam& beam : grain.reduced_light->beams(rho, z)) {
      const glm::dvec3 travel = beam.toward_rho * outward + beam.toward_z * sun;
      sum += phase(-glm::dot(direction, travel), grain.g) * beam.fluence;
    }
    return sum;
  }
};

/// Adds one path's radiance per sun; `normal` is where the view ray meets the sphere, `view` the direction of that ray.
void trace_path(const Grain& grain, const glm::dvec3& normal, const glm::dvec3& view,
                std::span<const glm::dvec3> to_light, Rng& rng, std::span<double> radiance) {
  Photon photon{grain.radius * normal, view, 1};
  const double cosine = -glm::dot(normal, view);
  const bool bends =
      (grain.boundary == Boundary::dielectric || grain.boundary == Boundary::lambert_refracted) && grain.eta != 1;
  if (grain.boundary == Boundary::dielectric) {
    // Radiance changes by the square of the index (Nicodemus, "Radiance", 1963).
    photon.weight = (1 - grain.interface().reflectance_from_outside(cosine)) / (grain.eta * grain.eta);
    if (photon.weight <= 0) return;
  }
  if (grain.boundary == Boundary::lambert_lambert) {
    photon.direction = sample_cosine(-normal, rng);
  } else if (bends) {
    if ((1 - cosine * cosine) >= grain.eta * grain.eta) return;
    photon.direction = refract(view, normal, grain.eta);
  }
  Gatherer gatherer{grain, to_light, radiance};
  walk(Sphere{grain.radius}, grain.interface(), Medium{grain.albedo, grain.g}, photon, rng, gatherer);
}

/// Distance along the ray to a sphere around the origin, or nothing.
std::optional<double> hit(const glm::dvec3& origin, const glm::dvec3& direction, double radius) {
  const double along = glm::dot(origin, direction);
  const glm::dvec3 nearest = origin - along * direction;
  const double room = radius * radius - glm::dot(nearest, nearest);
  if (room <= 0 || along >= 0 || glm::dot(origin, origin) <= radius * radius) return std::nullopt;
  return -along - std::sqrt(room);
}

}  // namespace

Picture trace_picture(const PictureCase& setup, const std::function<void()>& row_done) {
  check(setup);
  if (setup.mesh) return trace_mesh_picture(setup, row_done);
  const scene::Material& material = setup.material;
  std::vector<Grain> grains;
  std::size_t grain_of[3];
  for (int channel = 0; channel < 3; ++channel) {
    grain_of[channel] = grains.size();
    for (int before = 0; before < channel; ++before)
      if (material.sigma_a[before] == material.sigma_a[channel] &&
          material.sigma_s[before] == material.sigma_s[channel])
        grain_of[channel] = grain_of[before];
    if (grain_of[channel] == grains.size()) grains.emplace_back(setup, channel);
  }
  const std::size_t suns = setup.lights.size();
  const auto make_tracer = [&] {
    return [&, to_light = std::vector<glm::dvec3>(suns), per_sun = std::vector<double>(suns)](
               double x, double y, Rng& rng) mutable -> std::optional<glm::dvec3> {
      const Ray ray = view_ray(setup.clip_to_world, x, y);
      const glm::dvec3 origin = ray.origin - setup.centre;
      const std::optional<double> distance = hit(origin, ray.direction, setup.radius);
      if (!distance) return std::nullopt;
      const glm::dvec3 normal = glm::normalize(origin + *distance * ray.direction);
      for (std::size_t sun = 0; sun < suns; ++sun) to_light[sun] = sample_sun(setup.lights[sun], rng);
      glm::dvec3 radiance(0);
      for (std::size_t grain = 0; grain < grains.size(); ++grain) {
        std::fill(per_sun.begin(), per_sun.end(), 0.0);
        trace_path(grains[grain], normal, ray.direction, to_light, rng, per_sun);
        for (int channel = 0; channel < 3; ++channel)
          for (std::size_t sun = 0; sun < suns && grain_of[channel] == grain; ++sun)
            radiance[channel] += per_sun[sun] * setup.lights[sun].irradiance[channel];
      }
      return radiance;
    };
  };
  return trace_pixels(setup, make_tracer, row_done);
}

}  // namespace mesograin::referee

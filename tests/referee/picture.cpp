// Backward walks from each pixel; at every scattering the unscattered sunlight that crosses the point is gathered.
#include "picture.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "parallel.h"
#include "reduced_light.h"
#include "walk.h"

namespace mesograin::referee {
namespace {

void check(const PictureCase& setup) {
  const auto need = [](bool held, const char* sentence) {
    if (!held) throw std::invalid_argument(sentence);
  };
  need(setup.width > 0 && setup.height > 0 && setup.samples > 0, "width, height and samples must be at least 1.");
  need(setup.radius > 0, "The sphere's radius must be positive.");
  need(glm::distance(setup.camera, setup.centre) > setup.radius,
       "The camera must stand outside the sphere; move it away.");
  need(glm::length(glm::cross(setup.look_at - setup.camera, setup.up)) > 0,
       "The camera must look somewhere other than along its up direction.");
  need(setup.fov_degrees > 0 && setup.fov_degrees < 180, "The field of view must lie between 0 and 180 degrees.");
  need(setup.eta >= 0.5 && setup.eta <= 4, "eta must lie in [0.5, 4].");
  need(std::abs(setup.g) < 1, "g must lie inside (-1, 1).");
  need(setup.scale > 0, "scale must be positive.");
  for (int channel = 0; channel < 3; ++channel) {
    need(setup.sigma_a[channel] >= 0 && setup.sigma_s[channel] >= 0, "sigma_a and sigma_s must not be negative.");
    need(setup.sigma_a[channel] + setup.sigma_s[channel] > 0,
         "Every channel needs some medium: sigma_a + sigma_s must be positive in each.");
  }
  for (const Sun& sun : setup.suns) need(glm::length(sun.to_light) > 0, "A light needs a direction with a length.");
}

/// One channel's sphere, its lengths in mean free paths.
struct Grain {
  double radius, albedo, eta, g;
  Boundary boundary;
  std::optional<ReducedLight> reduced_light;  ///< only behind an interface that bends light

  Grain(const PictureCase& setup, int channel)
      : radius(setup.radius * setup.scale * (setup.sigma_a[channel] + setup.sigma_s[channel])),
        albedo(setup.sigma_s[channel] / (setup.sigma_a[channel] + setup.sigma_s[channel])),
        eta(setup.eta),
        g(setup.g),
        boundary(setup.boundary) {
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

struct View {
  glm::dvec3 right, up, forward;

  explicit View(const PictureCase& setup) : forward(glm::normalize(setup.look_at - setup.camera)) {
    const double reach = std::tan(glm::radians(setup.fov_degrees) / 2) / std::min(setup.width, setup.height);
    right = glm::normalize(glm::cross(forward, setup.up));
    up = glm::cross(right, forward) * (reach * setup.height);
    right *= reach * setup.width;
  }

  /// x and y from -1 to 1, to the right and upwards.
  glm::dvec3 ray(double x, double y) const { return glm::normalize(forward + x * right + y * up); }
};

/// Distance along the ray to the unit-less sphere, or nothing.
std::optional<double> hit(const glm::dvec3& origin, const glm::dvec3& direction, double radius) {
  const double along = glm::dot(origin, direction);
  const glm::dvec3 nearest = origin - along * direction;
  const double room = radius * radius - glm::dot(nearest, nearest);
  if (room <= 0 || along >= 0) return std::nullopt;
  return -along - std::sqrt(room);
}

glm::dvec3 sample_sun(const Sun& sun, Rng& rng) {
  const glm::dvec3 centre = glm::normalize(sun.to_light);
  if (sun.angle <= 0) return centre;
  return sample_cone(centre, 1 - rng.uniform() * (1 - std::cos(sun.angle / 2)), rng);
}

}  // namespace

Picture trace_picture(const PictureCase& setup) {
  check(setup);
  std::vector<Grain> grains;
  std::size_t grain_of[3];
  for (int channel = 0; channel < 3; ++channel) {
    grain_of[channel] = grains.size();
    for (int before = 0; before < channel; ++before)
      if (setup.sigma_a[before] == setup.sigma_a[channel] && setup.sigma_s[before] == setup.sigma_s[channel])
        grain_of[channel] = grain_of[before];
    if (grain_of[channel] == grains.size()) grains.emplace_back(setup, channel);
  }
  const View view(setup);
  const glm::dvec3 origin = setup.camera - setup.centre;
  const int strata = static_cast<int>(std::sqrt(setup.samples));
  Picture picture;
  picture.radiance.resize(static_cast<std::size_t>(setup.width) * setup.height);
  picture.noise.resize(picture.radiance.size());

  parallel(setup.height, setup.threads, [&](std::size_t row) {
    Rng rng(setup.seed, row);
    std::vector<glm::dvec3> to_light(setup.suns.size());
    std::vector<double> per_sun(setup.suns.size());
    for (int column = 0; column < setup.width; ++column) {
      glm::dvec3 sum(0), squares(0);
      for (int sample = 0; sample < setup.samples; ++sample) {
        // The first strata^2 paths are stratified over the pixel, the rest are anywhere in it.
        const bool stratified = sample < strata * strata;
        const double u = stratified ? (sample % strata + rng.uniform()) / strata : rng.uniform();
        const double v = stratified ? (sample / strata + rng.uniform()) / strata : rng.uniform();
        const glm::dvec3 ray = view.ray(2 * (column + u) / setup.width - 1, 1 - 2 * (row + v) / setup.height);
        const std::optional<double> distance = hit(origin, ray, setup.radius);
        if (!distance) continue;
        const glm::dvec3 normal = glm::normalize(origin + *distance * ray);
        for (std::size_t sun = 0; sun < setup.suns.size(); ++sun) to_light[sun] = sample_sun(setup.suns[sun], rng);
        glm::dvec3 radiance(0);
        for (std::size_t grain = 0; grain < grains.size(); ++grain) {
          std::fill(per_sun.begin(), per_sun.end(), 0.0);
          trace_path(grains[grain], normal, ray, to_light, rng, per_sun);
          for (int channel = 0; channel < 3; ++channel)
            if (grain_of[channel] == grain)
              for (std::size_t sun = 0; sun < setup.suns.size(); ++sun)
                radiance[channel] += per_sun[sun] * setup.suns[sun].irradiance[channel];
        }
        sum += radiance;
        squares += radiance * radiance;
      }
      const double samples = setup.samples;
      const glm::dvec3 mean = sum / samples;
      const glm::dvec3 variance = glm::max(squares / samples - mean * mean, glm::dvec3(0)) / std::max(1.0, samples - 1);
      const std::size_t pixel = row * setup.width + column;
      picture.radiance[pixel] = mean;
      picture.noise[pixel] = {std::sqrt(variance.x), std::sqrt(variance.y), std::sqrt(variance.z)};
    }
  });
  return picture;
}

}  // namespace mesograin::referee

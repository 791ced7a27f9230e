// Backward walks in a mesh, flat triangle by flat triangle.
#include "mesh_picture.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "base/error.h"
#include "mesh_body.h"
#include "mesh_light.h"
#include "pixels.h"
#include "view.h"

namespace mesograin::referee {
namespace {

constexpr double thinnest = 1e-6;

/// The mesh in the mean free paths of some channels, and the unscattered light of every sun in it.
struct Grain {
  double sigma_t;
  MeshBody body;
  RoughInterface interface;
  double g;
  double albedo = 0;     ///< the largest of its channels
  glm::dvec3 ratios{0};  ///< of each channel's albedo to it; 0 for channels that are another grain's
  std::vector<MeshLight> suns;

  Grain(const PictureCase& setup, double extinction)
      : sigma_t(extinction), body(*setup.mesh, setup.mesh_to_world, extinction), interface {
    {setup.material.boundary == scene::Boundary::dielectric ? setup.material.eta : 1.0}, setup.material.roughness
  }, g(setup.material.g) {
    for (const scene::DirectionalLight& sun : setup.lights)
      suns.emplace_back(body, interface, sun, g != 0, setup.seed, setup.threads);
  }
};

std::vector<Grain> grains_of(const PictureCase& setup) {
  const scene::Material& material = setup.material;
  std::vector<Grain> grains;
  std::vector<glm::dvec3> albedos;
  for (int channel = 0; channel < 3; ++channel) {
    const double sigma_s = material.scale * material.sigma_s[channel];
    const double sigma_t = std::max(sigma_s + material.scale * material.sigma_a[channel], thinnest);
    std::size_t at = 0;
    while (at < grains.size() && std::abs(grains[at].sigma_t / sigma_t - 1) > 1e-6) ++at;
    if (at == grains.size()) {
      grains.emplace_back(setup, sigma_t);
      albedos.emplace_back(0);
    }
    albedos[at][channel] = sigma_s / sigma_t;
  }
  for (std::size_t i = 0; i < grains.size(); ++i) {
    grains[i].albedo = std::max({albedos[i].r, albedos[i].g, albedos[i].b});
    if (grains[i].albedo > 0) grains[i].ratios = albedos[i] / grains[i].albedo;
  }
  return grains;
}

/// What a walk from the surface inwards gathers: a channel of radiance inside, for each sun's irradiance.
glm::dvec3 gathered(const Grain& grain, const std::vector<scene::DirectionalLight>& lights, glm::dvec3 place,
                    glm::dvec3 direction, Rng& rng) {
  constexpr double least_weight = 0.05;
  constexpr int most_steps = 1 << 20;
  glm::dvec3 sum(0), shares(1);
  double weight = 1;
  for (int step = 0; step < most_steps; ++step) {
    const double flight = -std::log(rng.uniform_positive());
    bool scatters = grain.body.clearance(place) > flight;
    if (!scatters) {
      const std::optional<MeshHit> hit = grain.body.first_hit(place, direction);
      if (!hit) break;
      scatters = glm::dot(hit->normal, direction) > 0 && flight < hit->distance;
      if (!scatters) {
        place += hit->distance * direction;
        direction = grain.interface.beyond(direction, hit->normal, rng);
        continue;
      }
    }
    place += flight * direction;
    weight *= grain.albedo;
    shares *= grain.ratios;
    if (weight < least_weight) {
      if (rng.uniform() * least_weight >= weight) break;
      weight = least_weight;
    }
    for (std::size_t sun = 0; sun < lights.size(); ++sun) {
      const MeshLight& light = grain.suns[sun];
      const double scattered =
          grain.g == 0 ? phase(1, 0) : phase(-glm::dot(light.direction(place, rng), direction), grain.g);
      sum += weight * scattered * light.fluence(place) * shares * lights[sun].irradiance;
    }
    direction = sample_phase(direction, grain.g, rng);
  }
  return sum;
}

}  // namespace

Picture trace_mesh_picture(const PictureCase& setup, const std::function<void()>& row_done) {
  if (setup.material.boundary != scene::Boundary::dielectric &&
      setup.material.boundary != scene::Boundary::index_matched)
    throw Error("On a mesh the referee's boundary must be dielectric or index_matched.");
  const std::vector<Grain> grains = grains_of(setup);
  const auto trace = [&](double x, double y, Rng& rng) -> std::optional<glm::dvec3> {
    const Ray ray = view_ray(setup.clip_to_world, x, y);
    glm::dvec3 radiance(0);
    for (const Grain& grain : grains) {
      const glm::dvec3 origin = grain.sigma_t * ray.origin;
      const std::optional<MeshHit> hit = grain.body.first_hit(origin, ray.direction);
      if (!hit) return std::nullopt;
      const double cosine = -glm::dot(hit->normal, ray.direction), eta = grain.interface.smooth.eta;
      if (cosine <= 0) return std::nullopt;
      // Radiance changes by the square of the index (Nicodemus, "Radiance", 1963).
      double passed = 1 / (eta * eta);
      glm::dvec3 inwards;
      if (grain.interface.rough()) {
        inwards = grain.interface.beyond(ray.direction, hit->normal, rng);
        if (glm::dot(inwards, hit->normal) >= 0) passed = 0;
      } else {
        inwards = eta == 1 ? ray.direction : refract(ray.direction, hit->normal, eta);
        passed *= 1 - grain.interface.smooth.reflectance_from_outside(cosine);
      }
      if (passed > 0)
        radiance += passed * gathered(grain, setup.lights, origin + hit->distance * ray.direction, inwards, rng);
    }
    return radiance;
  };
  return trace_pixels(
      setup, [&] { return trace; }, row_done);
}

}  // namespace mesograin::referee

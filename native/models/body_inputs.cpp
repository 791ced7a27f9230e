// The same theory solves sphere and half-space, so its own error cancels where they meet and a thick grain is model
// 1's.
#include "models/body_inputs.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "base/memo.h"
#include "models/light_about_inputs.h"
#include "physics/body/entering_ring.h"
#include "physics/body/exit_directions.h"
#include "physics/body/flowing_lobe.h"
#include "physics/body/half_space_exitance.h"
#include "physics/body/sphere_exitance.h"
#include "physics/channels.h"
#include "physics/half_space/dielectric_surface.h"
#include "physics/physics.h"
#include "physics/quadrature.h"

namespace mesograin::models {

using namespace physics;

namespace {

constexpr int cosine_count = 33;

// Two to an octave.
constexpr int radius_count = 9;

double table_radius(int row) { return body_radius(row / (radius_count - 1.0)); }

// Below 0, what a body keeps of the half-space's light, less 1; above 0, the exitance it has beyond the half-space's.
double difference(double body, double half_space) {
  return body < half_space ? body / half_space - 1.0 : body - half_space;
}

// Logarithm of the exitance where the normal makes this angle with the light.
double log_exitance(const std::vector<double>& cosines, const std::vector<double>& exitance, double angle) {
  const double cosine = std::cos(std::clamp(angle, 0.0, PI));
  const auto above = std::upper_bound(cosines.begin() + 1, cosines.end() - 1, cosine) - cosines.begin();
  const double share = (cosine - cosines[above - 1]) / (cosines[above] - cosines[above - 1]);
  return (1.0 - share) * std::log(exitance[above - 1]) + share * std::log(exitance[above]);
}

// How fast exitance fades along the surface, away from the light, per mean free path: over one on either side, as far
// as a look along the surface reaches.
double fading(const std::vector<double>& cosines, const std::vector<double>& exitance, std::size_t i,
              double optical_radius) {
  if (optical_radius <= 0.0 || *std::min_element(exitance.begin(), exitance.end()) <= 0.0) return 0.0;
  const double angle = std::acos(cosines[i]);
  const double step = 1.0 / optical_radius;
  const double fallen = log_exitance(cosines, exitance, angle - step) - log_exitance(cosines, exitance, angle + step);
  return std::clamp(0.5 * fallen, 0.0, largest_flow);
}

// Of light that leaves by the interface's lobe, over 1/(4 pi).
std::vector<double> mean_phases(const BodySurface& surface, double g, const std::vector<double>& cosines) {
  if (g == 0.0) return std::vector<double>(cosines.size(), 1.0);
  const ExitLobe lobe = exit_lobe(surface);
  const double sign = g < 0.0 ? -1.0 : 1.0;
  std::vector<double> means;
  for (const double cosine : cosines) {
    double sum = 0.0;
    for (const ExitDirection& direction : exit_directions(surface.eta, cosine, g)) {
      const double versine = 1.0 - sign * direction.inwards.z;
      sum += 4.0 * PI * direction.weight * surface.eta * surface.eta * lobe.factor * (1.0 + lobe.slope * direction.mu) *
             4.0 * PI * henyey_greenstein(versine, std::abs(g), 1.0 - std::abs(g));
    }
    // Where the peak is turned inwards, its quadrature may hold nothing: the function is nowhere less than backwards.
    means.push_back(std::max(sum, 4.0 * PI * henyey_greenstein(2.0, std::abs(g), 1.0 - std::abs(g))));
  }
  return means;
}

// Per reduced mean free path.
double lobe_decay(const BodyMedium& medium, const BodySurface& surface) {
  const double sigma_t = medium.reduced_sigma_t();
  return surface.cosine_exit || sigma_t <= 0.0 ? 0.0 : std::min(far_decay(medium) / sigma_t, largest_lobe_decay);
}

struct Answer {
  std::vector<double> differences;
  std::vector<double> flows;
};

Answer answer(const BodyMedium& medium, const BodySurface& surface, const SphereSingleScattering& single,
              const SphereUnscattered& unscattered, const Orders& orders) {
  const std::vector<double> cosines = body_cosines();
  std::vector<double> half_space(cosine_count, 0.0);
  const auto add = [](std::vector<double>& sum, const std::vector<double>& term, double factor) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += factor * term[i];
  };
  if (orders.multiple) add(half_space, half_space_multiple_exitance(medium, surface, cosines), 1.0);
  std::vector<double> half_space_once;
  if (orders.single > 0.0) {
    half_space_once = half_space_single_exitance(medium, surface.eta, cosines);
    add(half_space, half_space_once, orders.single);
  }

  // What is scattered once leaves by the interface's lobe times the phase function.
  const std::vector<double> mean_phase =
      orders.multiple ? std::vector<double>(cosine_count, 1.0) : mean_phases(surface, medium.g, cosines);

  const FlowingLobe lobe(surface);
  const double decay = lobe_decay(medium, surface);
  Answer result;
  for (int row = 0; row < radius_count; ++row) {
    const double radius = table_radius(row);
    const BodyMedium scaled{medium.sigma_a * radius, medium.sigma_s * radius, medium.g};
    std::vector<double> body(cosine_count, 0.0);
    if (orders.multiple) add(body, sphere_multiple_exitance(scaled, surface, cosines), 1.0);
    if (orders.single > 0.0 && medium.sigma_s > 0.0) add(body, single.exitance(scaled, half_space_once), orders.single);
    // Where it leaves by a cosine lobe, it is seen like diffused light, but does not flow.
    std::vector<double> all = body;
    if (orders.multiple && surface.cosine_entry) add(all, unscattered.exitance(scaled.rest_sigma_t()), 1.0);
    for (std::size_t i = 0; i < body.size(); ++i) {
      const double scattered = all[i] > 0.0 ? body[i] / all[i] : 0.0;
      const double flow = surface.cosine_exit ? 0.0 : scattered * fading(cosines, body, i, scaled.reduced_sigma_t());
      result.flows.push_back(flow);
      const double excess = difference(all[i], half_space[i]);
      const double seen = orders.multiple ? lobe.share(flow, decay) : 1.0 / mean_phase[i];
      result.differences.push_back(excess > 0.0 ? excess * seen : excess);
    }
  }
  return result;
}

// Its ways are those of every medium of one index and mean cosine.
std::shared_ptr<const SphereSingleScattering> single_scattering(double eta, double g) {
  static Memo<std::pair<double, double>, SphereSingleScattering> memo(2);
  return memo.get({eta, g}, [&] { return SphereSingleScattering(eta, g, body_cosines()); });
}

// Less of the world than this is not seen through a grain.
constexpr double least_seen = 0.002;

// What a sphere lets through of parallel light that is refracted, were nothing reflected: the integral of
// 2 mu exp(-2 sigma_t mu'), mu' the cosine inside, of which eta^2 mu' dmu' is mu dmu.
double seen_through(double eta, double sigma_t) {
  const double across = 2.0 * sigma_t;
  if (across < 1e-3) return 1.0;
  const auto beyond = [&](double mu) { return (1.0 + across * mu) * std::exp(-across * mu); };
  const double least = eta > 1.0 ? refracted_cosine(0.0, eta) : 0.0;
  return 2.0 * eta * eta * (beyond(least) - beyond(1.0)) / (across * across);
}

// Where light spreads as it enters, what crosses is in the tables.
void add_clear(const std::array<BodyMedium, 3>& media, const BodySurface& surface, MaterialInputs& inputs) {
  if (surface.cosine_entry) return;
  const glm::dvec3 sigma_t(media[0].rest_sigma_t(), media[1].rest_sigma_t(), media[2].rest_sigma_t());
  if (seen_through(surface.eta, std::min({sigma_t.r, sigma_t.g, sigma_t.b})) < least_seen) return;
  inputs.defines.emplace_back("CLEAR");
  const glm::dvec3 sigma_a(media[0].sigma_a, media[1].sigma_a, media[2].sigma_a);
  inputs.uniforms["clear_sigma_a"] = glm::vec3(sigma_a);
  inputs.uniforms["clear_sigma_s"] = glm::vec3(sigma_t - sigma_a);
  inputs.uniforms["clear_eta"] = static_cast<float>(surface.eta);
}

}  // namespace

std::vector<double> body_cosines() {
  std::vector<double> cosines;
  cosines.reserve(cosine_count);
  for (int i = 0; i < cosine_count; ++i) cosines.push_back(body_cosine(i / (cosine_count - 1.0)));
  return cosines;
}

void add_body_difference(const char* name, const scene::Material& material, double grain_radius, const Orders& orders,
                         MaterialInputs& inputs) {
  const BodySurface surface = body_surface(material);
  const std::shared_ptr<const SphereSingleScattering> single = single_scattering(surface.eta, material.g);
  const SphereUnscattered unscattered(surface, surface.cosine_entry ? body_cosines() : std::vector<double>());
  const std::array<BodyMedium, 3> media = body_media(material, grain_radius);
  const auto answers = for_each_channel(
      media, [&](const BodyMedium& medium) { return answer(medium, surface, *single, unscattered, orders); });
  Table table =
      pack({answers[0].differences, answers[1].differences, answers[2].differences}, cosine_count, radius_count);
  for (std::size_t i = 0; i < table.texels.size(); ++i) table.texels[i].a = static_cast<float>(answers[0].flows[i]);
  if (orders.multiple && !is_grey(media))
    inputs.tables["flow_table"] =
        pack({answers[0].flows, answers[1].flows, answers[2].flows}, cosine_count, radius_count);
  inputs.tables[name] = std::move(table);
}

void add_planar_body(const std::array<const SurfaceKernel*, 3>& kernels, const BodySurface& surface, double resolution,
                     MaterialInputs& inputs) {
  constexpr int distance_count = 200;
  // Some kernels take long: they are evaluated once, as far as the largest body reaches across, and interpolated.
  constexpr int known_count = 512;
  const double known_step = std::log1p(2.0 * table_radius(radius_count - 1) / resolution) / (known_count - 1.0);
  std::vector<double> known_distances;
  known_distances.reserve(known_count);
  for (int j = 0; j < known_count; ++j) known_distances.push_back(resolution * std::expm1(j * known_step));
  const auto known =
      for_each_channel(kernels, [&](const SurfaceKernel* kernel) { return kernel->evaluate(known_distances, 1.0); });
  const auto kernels_at = [&](double logarithm) {
    const std::size_t cell = std::min(static_cast<std::size_t>(logarithm / known_step), known_distances.size() - 2);
    const double t = std::min(logarithm / known_step - static_cast<double>(cell), 1.0);
    glm::dvec3 values;
    for (int channel = 0; channel < 3; ++channel)
      values[channel] = (1.0 - t) * known[channel][cell] + t * known[channel][cell + 1];
    return values;
  };
  const std::vector<double> cosines = body_cosines();
  Table table{cosine_count, radius_count, {}};
  for (int row = 0; row < radius_count; ++row) {
    const double radius = table_radius(row);
    std::vector<double> distances;
    std::vector<glm::dvec3> values;
    for (int j = 0; j < distance_count; ++j) {
      const double logarithm = std::log1p(2.0 * radius / resolution) * j / (distance_count - 1.0);
      distances.push_back(resolution * std::expm1(logarithm));
      values.push_back(kernels_at(logarithm));
    }
    for (double cosine : cosines) {
      glm::dvec3 exitance(0.0);
      glm::dvec3 before(0.0);
      for (std::size_t j = 0; j < distances.size(); ++j) {
        const double s = distances[j] / radius;
        const double ring = distances[j] * entering_ring(surface, cosine, std::max(-1.0, 1.0 - 0.5 * s * s));
        const glm::dvec3 here = ring * values[j];
        if (j > 0) exitance += 0.5 * (distances[j] - distances[j - 1]) * (before + here);
        before = here;
      }
      table.texels.emplace_back(glm::dvec4(exitance, 0.0));
    }
  }
  inputs.defines.emplace_back("PLANAR_PROFILE");
  inputs.tables["body_table"] = std::move(table);
}

void add_body_uniforms(const scene::Material& material, double grain_radius, MaterialInputs& inputs) {
  const BodySurface surface = body_surface(material);
  const std::array<BodyMedium, 3> media = body_media(material, grain_radius);
  // The sphere was solved for a smooth surface; all that a rough one changes about what it takes in is how much.
  const double taken_in = has_rough_surface(material) ? rough_passage(material).entering_ratio : 1.0;
  inputs.uniforms["body.radius"] = static_cast<float>(grain_radius);
  // A reduced mean free path of the densest channel, but no more than the grain's own detail.
  double densest = 0.0;
  for (const BodyMedium& medium : media) densest = std::max(densest, medium.reduced_sigma_t());
  inputs.uniforms["body.clear"] = static_cast<float>(grain_radius * std::min(1.0 / densest, 0.125));
  inputs.uniforms["body.eta"] = static_cast<float>(surface.eta);
  const ExitLobe lobe = exit_lobe(surface);
  inputs.uniforms["body.exit_slope"] = static_cast<float>(lobe.slope);
  inputs.uniforms["body.exit_factor"] = static_cast<float>(lobe.factor * taken_in);
  glm::vec3 decay_squared;
  for (int channel = 0; channel < 3; ++channel) {
    const double decay = lobe_decay(media[channel], surface);
    decay_squared[channel] = static_cast<float>(decay * decay);
  }
  inputs.uniforms["body.decay_squared"] = decay_squared;
  inputs.uniforms["body.even_factor"] = static_cast<float>(taken_in / (PI * surface.diffusion.exit_transmittance));
  add_clear(media, surface, inputs);
  add_light_about(material, grain_radius, inputs);
}

}  // namespace mesograin::models

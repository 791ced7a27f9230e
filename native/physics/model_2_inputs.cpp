// The same theory solves sphere and half-space, so its own error cancels where they meet and model 2 becomes model 1
// for a thick grain.
#include "physics/model_2_inputs.h"

#include <cmath>

#include "physics/body_medium.h"
#include "physics/channels.h"
#include "physics/dielectric_surface.h"
#include "physics/model_1_inputs.h"
#include "physics/sphere_exitance.h"

namespace mesograin::physics {
namespace {

constexpr int cosine_count = 33;

// Radii from an eighth of the grain's to its double, two to an octave; the shader's radius_coordinate says the same.
constexpr int radius_count = 9;

double table_radius(int row) { return std::exp2(0.5 * row - 3.0); }

// The shader's coordinate is sign(c) sqrt(|c|): the terminator is where exitance changes fastest.
std::vector<double> table_cosines() {
  std::vector<double> cosines;
  for (int i = 0; i < cosine_count; ++i) {
    const double u = 2.0 * i / (cosine_count - 1.0) - 1.0;
    cosines.push_back(u * std::abs(u));
  }
  return cosines;
}

// Below 0, what a body keeps of the half-space's light, less 1; above 0, the exitance it has beyond the half-space's.
double difference(double body, double half_space) {
  return body < half_space ? body / half_space - 1.0 : body - half_space;
}

struct Orders {
  bool single;
  bool multiple;
};

std::vector<double> differences(const BodyMedium& medium, const BodySurface& surface,
                                const SphereSingleScattering& single, const Orders& orders) {
  const std::vector<double> cosines = table_cosines();
  const double albedo = medium.sigma_t() > 0.0 ? medium.sigma_s / medium.sigma_t() : 0.0;
  std::vector<double> half_space(cosine_count, 0.0);
  const auto add = [](std::vector<double>& sum, const std::vector<double>& term, double factor) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += factor * term[i];
  };
  if (orders.multiple) add(half_space, half_space_multiple_exitance(medium, surface, cosines), 1.0);
  if (orders.single) add(half_space, half_space_single_exitance(surface.eta, cosines), albedo);

  std::vector<double> values;
  for (int row = 0; row < radius_count; ++row) {
    const double radius = table_radius(row);
    const BodyMedium scaled{medium.sigma_a * radius, medium.sigma_s * radius, medium.g};
    std::vector<double> body(cosine_count, 0.0);
    if (orders.multiple) add(body, sphere_multiple_exitance(scaled, surface, cosines), 1.0);
    if (orders.single && albedo > 0.0) add(body, single.exitance(scaled.sigma_t()), albedo);
    for (int i = 0; i < cosine_count; ++i) values.push_back(difference(body[i], half_space[i]));
  }
  return values;
}

}  // namespace

MaterialInputs model_2_inputs(const scene::Material& material, double grain_radius) {
  MaterialInputs inputs = model_1_inputs(material);
  inputs.light_maps = true;
  const BodySurface surface = body_surface(material);
  const std::array<BodyMedium, 3> media{body_medium(material, 0, grain_radius), body_medium(material, 1, grain_radius),
                                        body_medium(material, 2, grain_radius)};
  const SphereSingleScattering single(surface.eta, table_cosines());
  const auto add_table = [&](const char* name, const Orders& orders) {
    inputs.tables[name] = pack(
        for_each_channel(media, [&](const BodyMedium& medium) { return differences(medium, surface, single, orders); }),
        cosine_count, radius_count);
  };
  // Anisotropic first-order scattering keeps its phase function; everything else leaves by the interface's own lobe.
  const bool separate = !surface.cosine_entry && material.g != 0.0;
  if (separate) {
    inputs.defines.emplace_back("SEPARATE_SINGLE");
    add_table("single_difference", {.single = true, .multiple = false});
  }
  add_table("body_difference", {.single = !surface.cosine_entry && !separate, .multiple = true});
  inputs.uniforms["body.radius"] = static_cast<float>(grain_radius);
  const ExitLobe lobe = exit_lobe(surface);
  inputs.uniforms["body.exit_slope"] = static_cast<float>(lobe.slope);
  // The sphere was solved for a smooth surface; all that a rough one changes about what it takes in is how much.
  const double taken_in = has_rough_surface(material) ? rough_passage(material).entering_ratio : 1.0;
  inputs.uniforms["body.exit_factor"] = static_cast<float>(lobe.factor * taken_in);
  return inputs;
}

}  // namespace mesograin::physics

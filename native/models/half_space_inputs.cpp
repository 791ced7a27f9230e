// Every order of scattering comes from exactly one place: the table, the closed form, or the analytic first order.
#include "models/half_space_inputs.h"

#include <algorithm>
#include <cmath>

#include "base/memo.h"
#include "models/dielectric_inputs.h"
#include "physics/channels.h"
#include "physics/diffusion.h"
#include "physics/forward_peak.h"
#include "physics/fresnel_moments.h"
#include "physics/half_space/dielectric_surface.h"
#include "physics/half_space/half_space.h"
#include "physics/half_space/marched_light.h"
#include "physics/half_space/medium.h"
#include "physics/half_space/refracted_view.h"
#include "physics/physics.h"
#include "physics/table.h"

namespace mesograin::models {

using namespace physics;

namespace {

using scene::Boundary;
using scene::Material;
using scene::Profile;

// That of the passages, which lie in the table, too.
constexpr int half_space_table_size = Passage::table_size;
constexpr int view_table_size = 128;

std::array<Medium, 3> half_space_media(const Material& material) {
  return {half_space_medium(material, 0), half_space_medium(material, 1), half_space_medium(material, 2)};
}

// The cosines inside of the table's rows and columns.
std::vector<double> table_cosines(double eta) {
  std::vector<double> cosines = coordinate_cosines(eta, half_space_table_size);
  for (double& mu : cosines) mu = refracted_cosine(mu, eta);
  return cosines;
}

// A rough surface lets through by the same coordinates: one look into the table gives what is scattered and both
// passages.
void add_passages(const Table& passage, Table& table) {
  std::size_t texel = 0;
  for (const glm::vec4& row : passage.texels)
    for (const glm::vec4& column : passage.texels) table.texels[texel++].a = row.r * column.r;
}

void add_single_scattering(const Material& material, MaterialInputs& inputs) {
  glm::dvec3 albedo;
  double g = 0.0;
  for (int channel = 0; channel < 3; ++channel) {
    const Medium medium = half_space_medium(material, channel);
    albedo[channel] = medium.albedo;
    g = medium.g;
  }
  inputs.defines.emplace_back("SINGLE_SCATTERING");
  inputs.uniforms["material.albedo"] = glm::vec3(albedo);
  inputs.uniforms["material.absolute_g"] = static_cast<float>(std::abs(g));
  inputs.uniforms["material.one_minus_absolute_g"] = static_cast<float>(1.0 - std::abs(g));
  inputs.uniforms["material.sign_g"] = g < 0.0 ? -1.0F : 1.0F;
}

void add_half_space(const Material& material, double eta, bool first_order, MaterialInputs& inputs) {
  // Isotropic first-order scattering is as smooth as the rest and rides in the table.
  const bool isotropic = material.g == 0.0;
  const std::vector<double> mu = table_cosines(eta);
  inputs.defines.emplace_back("MULTIPLE_TABLE");
  const auto table_of = [&](const Medium& medium) {
    const HalfSpace half_space(medium, eta);
    if (first_order || isotropic) return half_space.interior_table(mu, first_order && isotropic);
    std::vector<double> values = half_space.interior_table(mu, true);
    const std::vector<double> marched = marched_in_half_space(medium, medium.g, mu, mu);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::max(values[i] - marched[i], 0.0);
    return values;
  };
  Table table =
      pack(for_each_channel(half_space_media(material), table_of), half_space_table_size, half_space_table_size);
  const auto passage = inputs.tables.find("passage");
  if (passage != inputs.tables.end()) add_passages(passage->second, table);
  inputs.tables["multiple_scattering"] = std::move(table);
  if (first_order && !isotropic) add_single_scattering(material, inputs);
}

void add_closed_form(const Material& material, double eta, MaterialInputs& inputs) {
  const DiffusionBoundary boundary = diffusion_boundary(eta);
  glm::dvec3 total;
  for (int channel = 0; channel < 3; ++channel) {
    const double one_minus_reduced_albedo = reduced_medium(material, channel).one_minus_albedo;
    total[channel] = material.profile == Profile::dipole
                         ? dipole_total(one_minus_reduced_albedo, boundary.a)
                         : better_dipole_total(one_minus_reduced_albedo, boundary.a, boundary.c_phi, boundary.c_e);
  }
  inputs.defines.emplace_back("MULTIPLE_CONSTANT");
  inputs.uniforms["material.diffuse"] = glm::vec3(total / (PI * boundary.exit_transmittance));
  // Jensen's total stands for all orders (his R_d -> 1 for a conservative medium); the better dipole begins with the
  // second.
  if (material.profile == Profile::better_dipole) add_single_scattering(material, inputs);
}

MaterialInputs interface_inputs(const Material& material, bool first_order) {
  MaterialInputs inputs;
  const double eta = material.boundary == Boundary::dielectric ? material.eta : 1.0;
  if (eta != 1.0) {
    inputs.defines.emplace_back("REFRACTION");
    inputs.uniforms["material.eta"] = static_cast<float>(eta);
  }
  add_dielectric(material, inputs);
  inputs.uniforms["material.inverse_eta_squared"] = static_cast<float>(1.0 / (eta * eta));
  if (material.profile == Profile::half_space)
    add_half_space(material, eta, first_order, inputs);
  else
    add_closed_form(material, eta, inputs);
  return inputs;
}

// The light enters by a cosine lobe and the viewer sees one: the spherical albedo of the half-space, over pi.
MaterialInputs lambert_lambert_inputs(const Material& material) {
  const std::array<double, 3> albedo = for_each_channel(
      half_space_media(material), [](const Medium& medium) { return HalfSpaceInterior(medium).spherical_albedo(); });
  MaterialInputs inputs;
  inputs.defines.emplace_back("MULTIPLE_CONSTANT");
  inputs.uniforms["material.diffuse"] = glm::vec3(glm::dvec3(albedo[0], albedo[1], albedo[2]) / PI);
  return inputs;
}

// Followed from the viewer: refracted into the medium, out again by a cosine lobe towards the light.
MaterialInputs lambert_refracted_inputs(const Material& material) {
  const auto channels = for_each_channel(half_space_media(material), [&](const Medium& medium) {
    const RefractedView view(medium, material.eta, material.roughness);
    std::vector<double> values;
    for (int i = 0; i < view_table_size; ++i) {
      const double coordinate = static_cast<double>(i) / (view_table_size - 1);
      values.push_back(view.albedo(coordinate * coordinate) / PI);
    }
    return values;
  });
  MaterialInputs inputs;
  inputs.defines.emplace_back("VIEW_TABLE");
  inputs.tables["multiple_scattering"] = pack(channels, view_table_size, 1);
  return inputs;
}

MaterialInputs make_half_space_inputs(const Material& material, bool first_order) {
  switch (material.boundary) {
    case Boundary::lambert_lambert:
      return lambert_lambert_inputs(material);
    case Boundary::lambert_refracted:
      return lambert_refracted_inputs(material);
    default:
      return interface_inputs(material, first_order);
  }
}

/// All that they depend on.
struct Key {
  Material material;
  bool first_order;

  bool operator==(const Key&) const = default;
};

// As many as a heap's colours (scene::by_colour).
constexpr std::size_t most_held = 32;

}  // namespace

MaterialInputs half_space_inputs(const Material& material, bool first_order) {
  static Memo<Key, MaterialInputs> memo(most_held);
  Key key{material, first_order};
  key.material.finish.reset();
  return *memo.get(key, [&] { return make_half_space_inputs(key.material, first_order); });
}

}  // namespace mesograin::models

// Everything is per grain radius, so that no unit and no scale can leave the range of single precision.
#include <algorithm>
#include <cmath>
#include <memory>

#include "models/body_inputs.h"
#include "models/dielectric_inputs.h"
#include "models/half_space_inputs.h"
#include "models/inputs_of_models.h"
#include "physics/body/body_medium.h"
#include "physics/body/half_space_exitance.h"
#include "physics/body/sphere_exitance.h"
#include "physics/body/sphere_refraction.h"
#include "physics/channels.h"
#include "physics/forward_peak.h"
#include "physics/half_space/half_space.h"
#include "physics/kernels/beyond_sphere.h"
#include "physics/kernels/kernel_tables.h"
#include "physics/kernels/planar_kernel.h"
#include "physics/kernels/sphere_kernel.h"
#include "physics/physics.h"

namespace mesograin::models {

using namespace physics;

namespace {

using scene::Material;
using scene::Profile;

// The tables' shortest step, in mean free paths.
constexpr double resolution_in_mean_free_paths = 0.05;

// How soon samples take an edge that faces the light into account, in mean free paths.
constexpr double turn_in_mean_free_paths = 1.5;

// In grain radii. Samples are drawn on a plane at the lit surface's height, whose rim is farther off than any point of
// the grain.
constexpr double largest_distance = 6.0;

PlanarProfile planar_profile(Profile profile) {
  if (profile == Profile::dipole) return PlanarProfile::dipole;
  if (profile == Profile::photon_beam) return PlanarProfile::photon_beam;
  return PlanarProfile::better_dipole;
}

// What the half-space sends back of light that enters straight down, as far as the kernel answers for it: what beam
// diffusion, whose shape is good and whose sum is not, is rescaled to. The similar isotropic medium stands for all.
double half_space_total(const BodyMedium& body, const BodySurface& surface) {
  const double sigma_t = body.reduced_sigma_t();
  const Medium medium{body.reduced_sigma_s() / sigma_t, body.sigma_a / sigma_t, 0.0};
  if (surface.cosine_entry) return HalfSpaceInterior(medium).spherical_albedo();
  const double transmittance = surface.eta == 1.0 ? 1.0 : fresnel_transmittance(1.0, 1.0, surface.eta);
  const BodyMedium similar{body.sigma_a, body.reduced_sigma_s(), 0.0};
  const double single = half_space_single_exitance(similar, surface.eta, {1.0}).front() / transmittance;
  return HalfSpace(medium, surface.eta).albedo_inside(1.0) - single;
}

std::shared_ptr<const SurfaceKernel> make_kernel(const BodyMedium& medium, const BodySurface& surface,
                                                 Profile profile) {
  if (profile == Profile::half_space) return std::make_shared<SphereKernel>(medium, surface);
  const bool rescaled = profile == Profile::photon_beam && medium.reduced_sigma_s() > 0.0;
  return std::make_shared<PlanarKernel>(planar_profile(profile), medium, surface,
                                        rescaled ? half_space_total(medium, surface) : 0.0);
}

void add_kernel(const std::array<BodyMedium, 3>& media, const BodySurface& surface, Profile profile,
                MaterialInputs& inputs) {
  const auto kernels =
      for_each_channel(media, [&](const BodyMedium& medium) { return make_kernel(medium, surface, profile); });
  const std::array<const SurfaceKernel*, 3> channels{kernels[0].get(), kernels[1].get(), kernels[2].get()};
  double thickest = 1e-3;
  for (const BodyMedium& medium : media) thickest = std::max(thickest, medium.reduced_sigma_t());
  const double resolution = resolution_in_mean_free_paths / thickest;
  const bool by_cosine = profile == Profile::half_space && !surface.cosine_entry;
  const KernelTables tables = kernel_tables(channels, surface, resolution, largest_distance, by_cosine);
  inputs.tables["kernel"] = tables.profile;
  inputs.tables["kernel_inverse"] = tables.inverse;
  inputs.uniforms["sampling.inverse_shortest"] = static_cast<float>(1.0 / tables.shortest);
  inputs.uniforms["sampling.columns_per_octave"] = static_cast<float>(tables.columns_per_octave());
  inputs.uniforms["sampling.turn"] = static_cast<float>(turn_in_mean_free_paths / thickest);
  inputs.uniforms["sampling.largest_depth"] = static_cast<float>(tables.largest_depth);
  if (profile != Profile::half_space) add_planar_body(channels, surface, resolution, inputs);
  // A planar profile's own plane is what it answers for.
  const glm::dvec3 beyond =
      profile == Profile::half_space ? share_beyond_sphere(tables, media, surface) : glm::dvec3(1.0);
  if (is_grey(media))
    inputs.uniforms["beyond_sphere"] = static_cast<float>(beyond.x);
  else
    inputs.uniforms["beyond_sphere"] = glm::vec3(beyond);
}

void add_single_scattering(const std::array<BodyMedium, 3>& media, double eta, MaterialInputs& inputs) {
  const SphereRefraction refraction(eta);
  Table table{SphereRefraction::size, SphereRefraction::size, {}};
  for (const RefractedLight& light : refraction.nodes())
    table.texels.emplace_back(glm::dvec4(light.irradiance, light.path_ratio, light.sideways, 1.0));
  inputs.defines.emplace_back("SINGLE_MARCHED");
  inputs.tables["refracted_light"] = std::move(table);
  const double g = media[0].g;
  const ForwardPeak peak(g);
  glm::dvec3 sigma_s;
  glm::dvec3 sigma_t;
  for (int channel = 0; channel < 3; ++channel) {
    sigma_s[channel] = media[channel].sigma_s;
    sigma_t[channel] = media[channel].rest_sigma_t();
  }
  inputs.uniforms["single.sigma_s"] = glm::vec3(sigma_s);
  inputs.uniforms["single.sigma_t"] = glm::vec3(sigma_t);
  if (peak.share > 0.0) {
    inputs.defines.emplace_back("FORWARD_PEAK");
    inputs.uniforms["single.peak"] = glm::vec3(peak.share * sigma_s);
    inputs.uniforms["single.rest"] = static_cast<float>(peak.rest);
    inputs.uniforms["single.rest_g"] = static_cast<float>(peak.rest_g);
  }
  inputs.uniforms["single.absolute_g"] = static_cast<float>(std::abs(g));
  inputs.uniforms["single.one_minus_absolute_g"] = static_cast<float>(1.0 - std::abs(g));
  inputs.uniforms["single.sign_g"] = g < 0.0 ? -1.0F : 1.0F;
}

void add_crossed(const std::array<BodyMedium, 3>& media, MaterialInputs& inputs) {
  inputs.defines.emplace_back("CROSSED");
  const glm::dvec3 across(2.0 * media[0].rest_sigma_t(), 2.0 * media[1].rest_sigma_t(), 2.0 * media[2].rest_sigma_t());
  if (is_grey(media))
    inputs.uniforms["crossed"] = static_cast<float>(across.x);
  else
    inputs.uniforms["crossed"] = glm::vec3(across);
}

}  // namespace

MaterialInputs model_3_inputs(const Material& material, double grain_radius) {
  const bool half_space = material.profile == Profile::half_space;
  MaterialInputs inputs = half_space ? half_space_inputs(material, false) : MaterialInputs{};
  inputs.defines.emplace_back("ENTRIES");
  const BodySurface surface = body_surface(material);
  const std::array<BodyMedium, 3> media = body_media(material, grain_radius);
  add_body_uniforms(material, grain_radius, inputs);
  if (half_space) {
    add_body_difference("body_table", material, grain_radius, {.single = 0.0, .multiple = true}, inputs);
  } else {
    if (surface.eta != 1.0) inputs.defines.emplace_back("REFRACTION");
    add_dielectric(material, inputs);
  }
  if (is_grey(media)) inputs.defines.emplace_back("GREY");
  if (half_space && surface.cosine_entry) add_crossed(media, inputs);
  add_kernel(media, surface, material.profile, inputs);
  // Jensen's dipole stands for all orders, and so does a kernel that light enters by a cosine lobe.
  if (!surface.cosine_entry && material.profile != Profile::dipole) add_single_scattering(media, surface.eta, inputs);
  return inputs;
}

}  // namespace mesograin::models

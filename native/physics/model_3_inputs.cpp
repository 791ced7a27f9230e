// Everything is per grain radius, so that no unit and no scale can leave the range of single precision.
#include "physics/model_3_inputs.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "physics/body_medium.h"
#include "physics/channels.h"
#include "physics/dielectric_inputs.h"
#include "physics/kernel_tables.h"
#include "physics/physics.h"
#include "physics/sphere_refraction.h"
#include "physics/surface_kernel.h"

namespace mesograin::physics {
namespace {

using scene::Material;
using scene::Profile;

// The table's shortest step, in mean free paths, and its rows over the cosine inside.
constexpr double resolution_in_mean_free_paths = 0.05;
constexpr int cosine_rows = 8;

// Over how many mean free paths light loses the evenness of its last scatterings. Compared with Monte Carlo on spheres:
// thick ones ask for more, thin ones for less.
constexpr double diffused_mean_free_paths = 3.0;

// In grain radii. Samples are drawn on a plane at the lit surface's height, whose rim is farther off than any point of
// the grain.
constexpr double largest_distance = 6.0;

PlanarProfile planar_profile(Profile profile) {
  if (profile == Profile::dipole) return PlanarProfile::dipole;
  if (profile == Profile::photon_beam) return PlanarProfile::photon_beam;
  return PlanarProfile::better_dipole;
}

std::shared_ptr<const SurfaceKernel> make_kernel(const BodyMedium& medium, const BodySurface& surface,
                                                 Profile profile) {
  if (profile == Profile::half_space) return std::make_shared<SphereKernel>(medium, surface);
  return std::make_shared<PlanarKernel>(planar_profile(profile), medium, surface);
}

void add_kernel(const std::array<BodyMedium, 3>& media, const BodySurface& surface, Profile profile,
                MaterialInputs& inputs) {
  const auto kernels =
      for_each_channel(media, [&](const BodyMedium& medium) { return make_kernel(medium, surface, profile); });
  double thickest = 1e-3;
  for (const BodyMedium& medium : media) thickest = std::max(thickest, medium.reduced_sigma_t());
  inputs.uniforms["sampling.diffused"] = static_cast<float>(diffused_mean_free_paths / thickest);
  const bool by_cosine = profile == Profile::half_space && !surface.cosine_entry;
  // Light that enters nearer to grazing is taken as this: it is little, and its kernel vanishes with its chord.
  const double least_mu = surface.eta > 1.0 ? std::max(refracted_cosine(0.0, surface.eta), 0.1) : 0.1;
  const KernelTables tables =
      kernel_tables({kernels[0].get(), kernels[1].get(), kernels[2].get()}, resolution_in_mean_free_paths / thickest,
                    largest_distance, by_cosine ? least_mu : 0.0, by_cosine ? cosine_rows : 1);
  inputs.tables["kernel"] = tables.profile;
  inputs.tables["kernel_inverse"] = tables.inverse;
  inputs.uniforms["sampling.shortest"] = static_cast<float>(tables.shortest);
  inputs.uniforms["sampling.step"] = static_cast<float>(tables.step);
  inputs.uniforms["sampling.largest_depth"] = static_cast<float>(tables.largest_depth);
  inputs.uniforms["sampling.least_mu"] = static_cast<float>(tables.least_mu);
  if (!by_cosine) return;
  // The mean way of a beam before it scatters or leaves; one for all channels, for it moves the point that is looked
  // up.
  inputs.defines.emplace_back("BEAM_SHIFT");
  double mean_way = 0.0;
  for (const BodyMedium& medium : media) {
    // Attenuated exponentially, and at most the mean chord.
    constexpr double mean_chord = 4.0 / 3.0;
    const double sigma_t = std::max(medium.reduced_sigma_t(), 1e-3);
    const double passed = std::exp(-sigma_t * mean_chord);
    mean_way += (1.0 / sigma_t - mean_chord * passed / (1.0 - passed)) / 3.0;
  }
  inputs.uniforms["sampling.beam"] = static_cast<float>(mean_way);
}

void add_single_scattering(const std::array<BodyMedium, 3>& media, double eta, MaterialInputs& inputs) {
  const SphereRefraction refraction(eta);
  Table table{SphereRefraction::size, SphereRefraction::size, {}};
  for (const RefractedLight& light : refraction.nodes())
    table.texels.emplace_back(glm::dvec4(light.irradiance, light.path_ratio, light.sideways, 1.0));
  inputs.defines.emplace_back("SINGLE_SCATTERING");
  inputs.tables["refracted_light"] = std::move(table);
  glm::dvec3 sigma_s;
  glm::dvec3 sigma_t;
  for (int channel = 0; channel < 3; ++channel) {
    sigma_s[channel] = media[channel].sigma_s;
    sigma_t[channel] = media[channel].sigma_t();
  }
  const double g = media[0].g;
  inputs.uniforms["body.sigma_s"] = glm::vec3(sigma_s);
  inputs.uniforms["body.sigma_t"] = glm::vec3(sigma_t);
  inputs.uniforms["body.absolute_g"] = static_cast<float>(std::abs(g));
  inputs.uniforms["body.one_minus_absolute_g"] = static_cast<float>(1.0 - std::abs(g));
  inputs.uniforms["body.sign_g"] = g < 0.0 ? -1.0F : 1.0F;
}

}  // namespace

MaterialInputs model_3_inputs(const Material& material, double grain_radius) {
  MaterialInputs inputs;
  inputs.light_maps = true;
  const BodySurface surface = body_surface(material);
  const std::array<BodyMedium, 3> media{body_medium(material, 0, grain_radius), body_medium(material, 1, grain_radius),
                                        body_medium(material, 2, grain_radius)};
  if (surface.eta != 1.0) inputs.defines.emplace_back("REFRACTION");
  add_dielectric(material, inputs);
  inputs.uniforms["body.radius"] = static_cast<float>(grain_radius);
  const ExitLobe lobe = exit_lobe(surface);
  inputs.uniforms["body.even_factor"] = static_cast<float>(1.0 / (PI * surface.diffusion.exit_transmittance));
  inputs.uniforms["body.exit_slope"] = static_cast<float>(lobe.slope);
  inputs.uniforms["body.exit_factor"] = static_cast<float>(lobe.factor);
  inputs.uniforms["body.eta"] = static_cast<float>(surface.eta);
  add_kernel(media, surface, material.profile, inputs);
  // Jensen's dipole stands for all orders, and so does a kernel that light enters by a cosine lobe.
  if (!surface.cosine_entry && material.profile != Profile::dipole) add_single_scattering(media, surface.eta, inputs);
  return inputs;
}

}  // namespace mesograin::physics

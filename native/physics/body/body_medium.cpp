// Coefficients per grain radius.
#include "physics/body/body_medium.h"

#include <algorithm>
#include <cmath>

#include "physics/physics.h"
#include "physics/quadrature.h"

namespace mesograin::physics {
namespace {

// Thicker grains than this answer like a half-space to the last bit that is stored.
constexpr double largest_optical_radius = 1e5;

// Keeps D finite in a medium that hardly interacts; nothing comes out of the diffusion equation there.
constexpr double least_optical_radius = 1e-9;

// What the beam loses, where transport extinction is `transport` and `removal` of the light is lost to this part.
DiffusionPart diffusion_part(const BodyMedium& medium, const BodySurface& surface, double transport, double removal) {
  const double diffusion = 1.0 / (3.0 * std::max(transport, least_optical_radius));
  const double extinction = medium.rest_sigma_t();
  return {.source = extinction > 0.0 ? medium.rest_sigma_s() / extinction : 0.0,
          .extinction = extinction,
          .spread = medium.reduced_sigma_t(),
          .decay = std::sqrt(removal / diffusion),
          .boundary_length = 2.0 * surface.diffusion.a * diffusion};
}

}  // namespace

BodyMedium body_medium(const scene::Material& material, int channel, double grain_radius) {
  const double unit = material.scale * grain_radius;
  BodyMedium medium{material.sigma_a[channel] * unit, material.sigma_s[channel] * unit,
                    std::clamp(material.g, -0.999, 0.999)};
  const double sigma_t = medium.reduced_sigma_t();
  if (sigma_t > largest_optical_radius) {
    medium.sigma_a *= largest_optical_radius / sigma_t;
    medium.sigma_s *= largest_optical_radius / sigma_t;
  }
  return medium;
}

std::array<BodyMedium, 3> body_media(const scene::Material& material, double grain_radius) {
  return {body_medium(material, 0, grain_radius), body_medium(material, 1, grain_radius),
          body_medium(material, 2, grain_radius)};
}

bool is_grey(const std::array<BodyMedium, 3>& media) { return media[0] == media[1] && media[0] == media[2]; }

BodySurface body_surface(const scene::Material& material) {
  BodySurface surface;
  surface.eta = material.boundary == scene::Boundary::dielectric ? material.eta : 1.0;
  surface.cosine_entry =
      material.boundary == scene::Boundary::lambert_lambert || material.boundary == scene::Boundary::lambert_refracted;
  surface.diffusion = diffusion_boundary(surface.eta);
  surface.cosine_exit = material.boundary == scene::Boundary::lambert_lambert;
  return surface;
}

ExitLobe exit_lobe(const BodySurface& surface) {
  if (surface.cosine_exit) return {0.0, 1.0 / PI};
  const double slope = 1.5 / surface.diffusion.a;
  double flux = 0.0;
  // Below the critical cosine nothing comes through to a rarer outside; seen from outside that is no direction at all.
  const double critical = surface.eta < 1.0 ? sine_of_cosine(surface.eta) : 0.0;
  for (const QuadratureNode& node : gauss_legendre(64)) {
    const double mu = critical + (1.0 - critical) * node.x;
    const double mu_inside = refracted_cosine(mu, surface.eta);
    const double transmittance = surface.eta == 1.0 ? 1.0 : fresnel_transmittance(mu, mu_inside, surface.eta);
    flux += 2.0 * PI * (1.0 - critical) * node.weight * mu * transmittance * (1.0 + slope * mu_inside);
  }
  return {slope, 1.0 / flux};
}

DiffusionPart all_orders(const BodyMedium& medium, const BodySurface& surface) {
  return diffusion_part(medium, surface, medium.reduced_sigma_t(), medium.sigma_a);
}

double far_decay(const BodyMedium& medium) {
  const double extinction = medium.reduced_sigma_t();
  if (extinction <= 0.0) return 0.0;
  const double absorbed = medium.sigma_a / extinction;
  return extinction * std::sqrt(3.0 * absorbed / (1.0 + absorbed));
}

DiffusionPart first_order(const BodyMedium& medium, const BodySurface& surface) {
  return diffusion_part(medium, surface, medium.rest_sigma_t(), medium.rest_sigma_t());
}

}  // namespace mesograin::physics

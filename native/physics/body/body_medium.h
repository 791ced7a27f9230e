// One colour channel of a grain's medium with the grain's radius as the unit of length.
#pragma once

#include <array>

#include "physics/forward_peak.h"
#include "physics/fresnel_moments.h"
#include "scene/material.h"

namespace mesograin::physics {

struct BodyMedium {
  double sigma_a = 0.0;
  double sigma_s = 0.0;
  double g = 0.0;

  double sigma_t() const { return sigma_a + sigma_s; }
  double reduced_sigma_s() const { return (1.0 - g) * sigma_s; }
  double reduced_sigma_t() const { return sigma_a + reduced_sigma_s(); }

  /// Without the phase function's peak.
  double rest_sigma_s() const { return ForwardPeak(g).rest * sigma_s; }
  double rest_sigma_t() const { return sigma_a + rest_sigma_s(); }

  bool operator==(const BodyMedium&) const = default;
};

/// `material`'s medium in one channel, per `grain_radius`; optical radii beyond 1e5 are taken as that.
BodyMedium body_medium(const scene::Material& material, int channel, double grain_radius);

/// `material`'s media in red, green and blue.
std::array<BodyMedium, 3> body_media(const scene::Material& material, double grain_radius);

/// Whether the three are one medium, so that only one need be computed.
bool is_grey(const std::array<BodyMedium, 3>& media);

/// How light gets into a body and out again.
struct BodySurface {
  double eta = 1.0;             ///< what refracts; 1 for every boundary but the dielectric
  bool cosine_entry = false;    ///< light spreads by a cosine lobe as it enters
  DiffusionBoundary diffusion;  ///< of `eta`
  bool cosine_exit = false;     ///< light leaves by a cosine lobe, wherever it came from
};

BodySurface body_surface(const scene::Material& material);

/// The lobe by which diffused light leaves: transmittance(mu) (1 + slope mu') factor, whose flux is 1; mu' is the
/// cosine inside; without slope where the surface diffuses what leaves. Below a surface that passes 1/(2A) of the
/// fluence, P1 radiance is proportional to 1 + 3/(2A) mu' (Ishimaru 1978 eq. 9-12).
struct ExitLobe {
  double slope;
  double factor;
};

ExitLobe exit_lobe(const BodySurface& surface);

/// The diffusion equation's constants for one part of the light in a BodyMedium (P1: D = 1/(3 sigma_t')).
struct DiffusionPart {
  double source;           ///< per unit of light that is taken from the beam that feeds it
  double extinction;       ///< of that beam
  double spread;           ///< what is taken from it lies along its way t as exp(-spread t)
  double decay;            ///< sqrt(removal/D)
  double boundary_length;  ///< 2 A D
};

/// Scattering of any order but that within the phase function's peak, which counts as none. It begins where light has
/// forgotten its direction, as in the similar medium: sigma_s', sigma_t', g = 0 (Ishimaru 1978 eq. 9-20; van de Hulst
/// 1980 section 14.1).
DiffusionPart all_orders(const BodyMedium& medium, const BodySurface& surface);

/// How fast light of all orders fades far from where it entered, per grain radius: Grosjean's modified diffusion,
/// within 5 % of the exact asymptotic decay (Case and Zweifel 1967, section 4.3) for albedos of 0.5 and more, where P1
/// is up to 28 % off (Grosjean 1956; d'Eon and Irving 2011 section 4.3).
double far_decay(const BodyMedium& medium);

/// Scattering once, in the same approximation: all that is scattered again is removed, and light travels as far as it
/// does unscattered. all_orders - first_order are the orders from two up; each order of the diffusion equation's
/// Neumann series is positive, hence so is the difference for g = 0.
DiffusionPart first_order(const BodyMedium& medium, const BodySurface& surface);

}  // namespace mesograin::physics

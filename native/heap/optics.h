// What a spherical grain is made of, as light meets it: lengths are in its radius.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <string_view>
#include <vector>

#include "scene/material.h"

namespace mesograin::heap {

/// What happens at the surface. The last two are the boundaries of scene::Boundary with a cosine lobe.
enum class Surface { lambert, mirror, index_matched, dielectric, lambert_lambert, lambert_refracted };
inline constexpr std::array<std::string_view, 6> surface_names{"lambert",    "mirror",          "index_matched",
                                                               "dielectric", "lambert_lambert", "lambert_refracted"};

struct Optics {
  Surface surface = Surface::lambert;
  /// Of an opaque surface; of another, unless black, that of the Lambert surface that it is to what others send.
  glm::dvec3 reflectance{0.0};
  glm::dvec3 sigma_t{0.0};  ///< of the medium, per radius
  glm::dvec3 albedo{0.0};   ///< of one scattering
  double g = 0.0;
  double eta = 1.0;
  double roughness = 0.0;  ///< of a mirror
  bool lens = true;        ///< what refracts is as round as the sphere: no crystal, whose facets throw light back

  bool opaque() const { return surface == Surface::lambert || surface == Surface::mirror; }

  /// Whether light that others have sent meets a Lambert surface in its place.
  bool veiled() const { return !opaque() && reflectance != glm::dvec3(0.0); }

  /// Whether light may go straight through without meeting anything.
  bool transparent() const { return surface == Surface::index_matched; }

  /// Of light from everywhere, the share that does not go straight through without meeting anything.
  glm::dvec3 met() const;

  /// Whether light is followed to each scattering in what is seen of it.
  bool followed() const;

  /// Whether its surface refracts and 1 % of the light or more goes through its middle, in some channel.
  bool clear() const;

  /// Whether its surface refracts and hardly anything goes through its middle unscattered.
  bool turbid() const { return surface == Surface::dielectric && !clear() && !veiled(); }

  /// Whether of light through its middle less is scattered than is not, in every channel.
  bool scatters_little() const;

  bool operator==(const Optics&) const = default;
};

/// Of a sphere of `radius` in scene units. What is too thick for its depth to matter is made as thick as that.
/// A rough dielectric surface counts as smooth.
Optics optics_of(const scene::Material& material, double radius);

/// What grains are to each other. Few numbers a grain tell from where light leaves it, not that it goes on as it came:
/// what a transparent one scatters forwards (g > 0) counts as what crosses it, as the similar medium has it that
/// scatters evenly, sigma_s (1 - g) (van de Hulst 1980, section 14.1.3).
Optics of_others(const Optics& optics);
std::vector<Optics> of_others(std::vector<Optics> kinds);

/// The same, but for what one is to others alone: what it makes of their light where it is seen.
Optics seen_among_others(const Optics& optics);

}  // namespace mesograin::heap

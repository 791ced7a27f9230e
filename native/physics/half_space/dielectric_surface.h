// A rough dielectric surface: how much it reflects of a beam, and hence how much enters.
#pragma once

#include <vector>

#include "scene/material.h"

namespace mesograin::physics {

/// GGX microfacets that are Fresnel mirrors, one reflection each (shaders/physics/dielectric.glsl). What is not
/// reflected enters, and so does what a second facet would catch.
class RoughDielectric {
 public:
  /// `alpha` of 0 is taken as the narrowest highlight that is drawn.
  RoughDielectric(double eta, double alpha, scene::Masking masking);

  /// The fraction of a beam at cosine `mu` that is reflected, by quadrature over the visible normals. Within 1e-3; 4e-3
  /// for eta < 1.
  double reflected(double mu) const;

  /// The fraction that enters: 1 - reflected. Into a grain of eta < 1 no more than through a smooth surface, since
  /// beyond the critical angle light that enters a rough one has no refracted direction here: it is lost.
  double entering(double mu) const;

 private:
  double eta_;
  double alpha_;
  bool correlated_;
};

/// Whether the material has a surface that reflects and refracts.
bool has_dielectric_surface(const scene::Material& material);

/// Whether it is rough, too.
bool has_rough_surface(const scene::Material& material);

/// The cosines outside at which half_space_coordinate (shaders/physics/half_space.glsl) is 0, 1/(count-1), ..., 1.
std::vector<double> coordinate_cosines(double eta, int count);

/// What the models multiply light by that passes a rough dielectric surface, one way or the other.
struct Passage {
  static constexpr int table_size = 64;
  std::vector<double> transmittance;  ///< at coordinate_cosines(eta, table_size)
  double entering_ratio = 1.0;        ///< what a convex body takes in of parallel light, over a smooth one's
};

/// `entering` times a factor near 1, the same both ways, so that reciprocity holds: it makes a half-space of the
/// material that does not absorb send back all that enters, as it does through the smooth surface for which it is
/// solved.
Passage rough_passage(const scene::Material& material);

}  // namespace mesograin::physics

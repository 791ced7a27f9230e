// A grain's material as every room names it: coefficients per scene unit, GGX roughness, and which physics answers.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <string_view>

namespace mesograin::scene {

enum class Model { lambert, conductor, model_1, model_2, model_3 };

/// What happens at the grain's surface; the last two are what Cycles' Subsurface Scattering node solves.
enum class Boundary {
  dielectric,         ///< smooth or GGX-rough interface of relative index eta
  index_matched,      ///< no interface: collimated entry, exact exit
  lambert_lambert,    ///< index-matched walk, cosine lobe on the light's and on the view's side (Blender 3.4)
  lambert_refracted,  ///< index-matched walk, cosine lobe on the light's side, view ray refracted by eta (Blender 4)
};

enum class Masking { correlated, separable };

/// The theory that answers for multiple scattering.
enum class Profile { half_space, better_dipole, dipole, photon_beam };

struct Material {
  Model model = Model::lambert;
  glm::dvec3 reflectance{0.5};  ///< linear RGB; lambert's albedo, conductor's Fresnel reflectance
  glm::dvec3 sigma_a{0.1};      ///< absorption coefficient, per scene unit, linear RGB
  glm::dvec3 sigma_s{0.9};      ///< scattering coefficient, per scene unit, linear RGB
  double g = 0.0;               ///< mean cosine of the Henyey-Greenstein phase function, in [-1, 1]
  double eta = 1.3;             ///< relative index of refraction, in [0.5, 4]
  double roughness = 0.0;       ///< GGX alpha, in [0, 1]
  double scale = 1.0;           ///< dimensionless, multiplies sigma_a and sigma_s
  bool specular = true;         ///< light that a dielectric boundary reflects is seen
  Boundary boundary = Boundary::dielectric;
  Masking masking = Masking::correlated;
  Profile profile = Profile::half_space;

  bool operator==(const Material&) const = default;
};

inline constexpr std::array<std::string_view, 5> model_names{"lambert", "conductor", "model_1", "model_2", "model_3"};
inline constexpr std::array<std::string_view, 4> boundary_names{"dielectric", "index_matched", "lambert_lambert",
                                                                "lambert_refracted"};
inline constexpr std::array<std::string_view, 2> masking_names{"correlated", "separable"};
inline constexpr std::array<std::string_view, 4> profile_names{"half_space", "better_dipole", "dipole", "photon_beam"};

/// Throws Error, naming the parameter, the value that came and the range allowed.
void validate(const Material& material);

/// The enumerator called `name`; each throws Error listing the names allowed.
Model parse_model(std::string_view name);
Boundary parse_boundary(std::string_view name);
Masking parse_masking(std::string_view name);
Profile parse_profile(std::string_view name);

}  // namespace mesograin::scene

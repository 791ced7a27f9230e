// Angular moments of the Fresnel reflectance, exact, and the diffusion boundary constants that follow from them.
#pragma once

namespace mesograin::physics {

/// 2 C_1 = 2 int F mu dmu and 3 C_2 = 3 int F mu^2 dmu over mu in [0, 1] (d'Eon & Irving 2011, section 5.2), for light
/// that meets an interface behind which the index is `eta` times that in front. The complements are integrals of 1 - F,
/// not differences.
struct FresnelMoments {
  double one_minus_two_c1;
  double one_minus_three_c2;

  double two_c1() const { return 1.0 - one_minus_two_c1; }
  double three_c2() const { return 1.0 - one_minus_three_c2; }
};

FresnelMoments fresnel_moments(double eta);

/// For a medium of relative index eta, seen from outside.
struct DiffusionBoundary {
  double a;                   ///< (1 + 3 C_2)/(1 - 2 C_1), inside (d'Eon & Irving 2011 eq. 18)
  double c_phi;               ///< (1 - 2 C_1)/4, inside (d'Eon & Irving 2011 eq. 16)
  double c_e;                 ///< (1 - 3 C_2)/2, inside (d'Eon & Irving 2011 eq. 16)
  double exit_transmittance;  ///< 1 - 2 C_1, outside: what normalises an exit lobe F_t(mu)/pi
};

DiffusionBoundary diffusion_boundary(double eta);

}  // namespace mesograin::physics

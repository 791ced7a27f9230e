// The closed forms of diffusion theory against what was published with them.
#include "physics/diffusion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "physics/fresnel_moments.h"
#include "physics/physics.h"

namespace mesograin::physics {
namespace {

// The boundary that Jensen's table was made with: Egan & Hilgeman's fit of the diffuse Fresnel reflectance.
double egan_boundary(double eta) {
  const double reflectance = -1.440 / (eta * eta) + 0.710 / eta + 0.668 + 0.0636 * eta;
  return (1.0 + reflectance) / (1.0 - reflectance);
}

struct Measured {
  const char* name;
  double eta;
  double reduced_sigma_s[3];
  double sigma_a[3];
  double reflectance[3];
};

// Jensen et al. 2001, figure 5; marble is listed with eta = 1.5.
constexpr Measured jensen_table[] = {
    {"apple", 1.3, {2.29, 2.39, 1.97}, {.0030, .0034, .046}, {.846, .841, .528}},
    {"chicken1", 1.3, {.15, .21, .38}, {.015, .077, .19}, {.314, .156, .126}},
    {"chicken2", 1.3, {.19, .25, .32}, {.018, .088, .20}, {.321, .160, .108}},
    {"cream", 1.3, {7.38, 5.47, 3.15}, {.0002, .0028, .0163}, {.976, .900, .725}},
    {"ketchup", 1.3, {.18, .07, .03}, {.061, .97, 1.45}, {.164, .006, .002}},
    {"marble", 1.5, {2.19, 2.62, 3.00}, {.0021, .0041, .0071}, {.830, .791, .753}},
    {"potato", 1.3, {.68, .70, .55}, {.0024, .0090, .12}, {.764, .613, .213}},
    {"skimmilk", 1.3, {.70, 1.22, 1.90}, {.0014, .0025, .0142}, {.815, .813, .682}},
    {"skin1", 1.3, {.74, .88, 1.01}, {.032, .17, .48}, {.436, .227, .131}},
    {"skin2", 1.3, {1.09, 1.59, 1.79}, {.013, .070, .145}, {.623, .433, .343}},
    {"spectralon", 1.3, {11.6, 20.4, 14.9}, {0, 0, 0}, {1, 1, 1}},
    {"wholemilk", 1.3, {2.55, 3.21, 3.77}, {.0011, .0024, .014}, {.908, .881, .759}},
};

TEST(Dipole, ReproducesJensensTable) {
  for (const Measured& row : jensen_table)
    for (int channel = 0; channel < 3; ++channel) {
      const double absorbed = row.sigma_a[channel] / (row.sigma_a[channel] + row.reduced_sigma_s[channel]);
      EXPECT_NEAR(dipole_total(absorbed, egan_boundary(row.eta)), row.reflectance[channel], 6e-4)
          << row.name << channel;
    }
}

TEST(Dipole, IsTheIntegralOfItsProfileOverThePlane) {
  const double a = diffusion_boundary(1.4).a;
  for (const double absorbed : {0.001, 0.1, 0.5, 0.9}) {
    const double albedo = 1.0 - absorbed;
    const double s = std::sqrt(3.0 * absorbed);
    const double depths[] = {1.0, 1.0 + 4.0 / 3.0 * a};
    double integral = 0.0;
    for (double radius = 0.0, step = 0.002; radius < 400.0; radius += step) {
      const double middle = radius + 0.5 * step;
      for (const double z : depths) {
        const double d = std::sqrt(middle * middle + z * z);
        integral += step * 2.0 * PI * middle * albedo / (4.0 * PI) * z * (1.0 + s * d) * std::exp(-s * d) / (d * d * d);
      }
      if (radius > 10.0) step = 0.02;
    }
    EXPECT_NEAR(dipole_total(absorbed, a) / integral, 1.0, absorbed < 0.01 ? 2e-3 : 1e-4) << absorbed;
  }
}

TEST(BetterDipole, IsThePrintedForm) {
  const DiffusionBoundary boundary = diffusion_boundary(1.3);
  for (const double absorbed : {0.01, 0.1, 0.5, 0.9}) {
    const double albedo = 1.0 - absorbed;
    const double diffusion = (2.0 * absorbed + albedo) / 3.0;
    const double s = std::sqrt(absorbed / diffusion);
    const double e1 = std::exp(-s);
    const double e2 = std::exp(-s * (1.0 + 4.0 * boundary.a * diffusion));
    const double printed =
        albedo * albedo * (boundary.c_phi / (2.0 * diffusion * s) * (e1 - e2) + 0.5 * boundary.c_e * (e1 + e2));
    EXPECT_NEAR(better_dipole_total(absorbed, boundary.a, boundary.c_phi, boundary.c_e), printed, 1e-12);
  }
}

TEST(BetterDipole, ReturnsEverythingWithoutAbsorption) {
  for (const double eta : {0.5, 1.0, 1.3, 2.0, 4.0}) {
    const DiffusionBoundary boundary = diffusion_boundary(eta);
    EXPECT_NEAR(better_dipole_total(0.0, boundary.a, boundary.c_phi, boundary.c_e), 1.0, 1e-12) << eta;
    // and gets there without a jump
    EXPECT_NEAR(better_dipole_total(1e-14, boundary.a, boundary.c_phi, boundary.c_e), 1.0, 1e-4) << eta;
  }
}

TEST(Diffusion, ReturnsNothingWithoutScattering) {
  EXPECT_EQ(dipole_total(1.0, 2.0), 0.0);
  EXPECT_EQ(better_dipole_total(1.0, 2.0, 0.2, 0.3), 0.0);
}

TEST(Diffusion, ASourceAndItsImageFarAwayDoNotCancel) {
  // Far away the difference is that of a dipole: (z_v^2 - z_r^2) (1 + k r)/(2 r^3) exp(-k r), to first order in 1/r^2.
  for (const double r : {1e4, 1e5, 1e6, 1e7})
    for (const double decay : {0.0, 1e-7, 1e-5}) {
      const double ours = image_difference(std::hypot(r, 1.0), std::hypot(r, 4.1), 15.81, decay);
      const double dipole = 15.81 * (1.0 + decay * r) / (2.0 * r * r * r) * std::exp(-decay * r);
      EXPECT_NEAR(ours / dipole, 1.0, 1e-5) << r << " " << decay;
    }
}

}  // namespace
}  // namespace mesograin::physics

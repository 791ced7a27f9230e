// The diffusing sphere against closed forms, conservation and its half-space limit.
#include "physics/body/sphere_diffusion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "physics/body/half_space_exitance.h"
#include "physics/body/sphere_exitance.h"
#include "physics/body/sphere_refraction.h"
#include "physics/physics.h"

namespace mesograin::physics {
namespace {

BodySurface surface_of(double eta) { return {eta, false, diffusion_boundary(eta)}; }

std::vector<double> even_cosines(int count) {
  std::vector<double> cosines;
  cosines.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) cosines.push_back((2.0 * i + 1.0) / count - 1.0);
  return cosines;
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

// Of each radius among others.
std::vector<double> transfer_of(const SphereDiffusion& solution, double r) {
  SideBySide radii{0.1, 0.7, r, 0.0, 1.0, 0.5, r, 0.3};
  std::vector<SideBySide> several(static_cast<std::size_t>(solution.largest_order()) + 1);
  solution.transfer(radii, several);
  std::vector<double> transfer;
  transfer.reserve(several.size());
  for (const SideBySide& order : several) {
    EXPECT_EQ(order[2], order[6]);
    transfer.push_back(order[2]);
  }
  return transfer;
}

TEST(SphereDiffusion, AgreesWithTheClosedFormOfTheLowestOrders) {
  for (double decay : {0.01, 0.3, 1.0, 7.0, 60.0})
    for (double boundary_length : {0.01, 0.5, 3.0})
      for (double r : {0.0, 1e-3, 0.4, 0.97, 1.0}) {
        const std::vector<double> transfer = transfer_of(SphereDiffusion(decay, boundary_length, 29), r);
        const auto i0 = [](double x) { return x < 1e-6 ? 1.0 : std::sinh(x) / x; };
        const auto i1 = [](double x) {
          return x < 1e-2 ? x / 3.0 * (1.0 + x * x / 10.0) : std::cosh(x) / x - std::sinh(x) / (x * x);
        };
        const double gamma0 = decay * i1(decay) / i0(decay);
        const double gamma1 = decay * i0(decay) / i1(decay) - 2.0;
        EXPECT_NEAR(transfer[0] * i0(decay) * (1.0 + boundary_length * gamma0) / i0(decay * r), 1.0, 1e-7)
            << decay << ' ' << r;
        EXPECT_NEAR(transfer[1], i1(decay * r) / i1(decay) / (1.0 + boundary_length * gamma1), 1e-7)
            << decay << ' ' << r;
      }
}

TEST(SphereDiffusion, WithoutAbsorptionIsAPowerOfTheRadiusAndLosesNothing) {
  const std::vector<double> transfer = transfer_of(SphereDiffusion(0.0, 0.7, 40), 0.8);
  for (int l = 0; l <= 40; ++l) EXPECT_NEAR(transfer[l], std::pow(0.8, l) / (1.0 + 0.7 * l), 1e-9) << l;
}

TEST(SphereRefraction, CarriesThroughTheMiddleWhatEntered) {
  for (double eta : {1.0, 1.1, 1.3}) {
    const SphereRefraction refraction(eta);
    double flux = 0.0;
    constexpr int rings = 2000;
    for (int i = 0; i < rings; ++i) {
      const double x = (i + 0.5) / rings;
      const RefractedLight light = refraction.at(x, 0.0);
      flux += 2.0 * x / rings * light.irradiance * std::sqrt(1.0 - light.sideways * light.sideways);
    }
    EXPECT_NEAR(flux, diffusion_boundary(eta).exit_transmittance, 0.01) << eta;
  }
}

TEST(SphereExitance, AThickSphereAnswersLikeAHalfSpace) {
  const std::vector<double> cosines{0.4, 0.7, 1.0};
  for (double eta : {1.0, 1.3, 1.6})
    for (double albedo : {0.1, 0.5, 0.9, 0.999}) {
      const BodyMedium medium{(1.0 - albedo) * 2e3, albedo * 2e3, 0.0};
      const std::vector<double> sphere = sphere_multiple_exitance(medium, surface_of(eta), cosines);
      const std::vector<double> half_space = half_space_multiple_exitance(medium, surface_of(eta), cosines);
      const std::vector<double> once = SphereSingleScattering(eta, 0.0, cosines).exitance({0.0, 2e3, 0.0});
      const std::vector<double> half_space_once = half_space_single_exitance({0.0, 2e3, 0.0}, eta, cosines);
      for (std::size_t i = 0; i < cosines.size(); ++i) {
        EXPECT_NEAR(sphere[i] / half_space[i], 1.0, 0.06) << eta << ' ' << albedo << ' ' << cosines[i];
        if (eta >= 1.0) {
          EXPECT_NEAR(once[i] / half_space_once[i], 1.0, 0.1) << eta << ' ' << cosines[i];
        }
      }
    }
}

TEST(SphereExitance, LightScatteredOnceNeedsTheHalfSpaceOnceForAllSizes) {
  const std::vector<double> cosines{-0.5, 0.1, 0.4, 0.7, 1.0};
  for (double g : {-0.6, 0.0, 0.3, 0.95})
    for (double eta : {1.0, 1.5}) {
      const SphereSingleScattering single(eta, g, cosines);
      const BodyMedium thick{0.7, 90.0, g};
      const std::vector<double> half_space = half_space_single_exitance(thick, eta, cosines);
      for (double radius : {1.0, 0.3, 0.001}) {
        const BodyMedium thinner{thick.sigma_a * radius, thick.sigma_s * radius, g};
        const std::vector<double> own = single.exitance(thinner);
        const std::vector<double> shared = single.exitance(thinner, half_space);
        for (std::size_t i = 0; i < cosines.size(); ++i)
          EXPECT_NEAR(shared[i], own[i], 1e-12 * half_space[i] + 1e-15) << g << ' ' << eta << ' ' << radius;
      }
    }
}

TEST(SphereExitance, GivesBackAtMostWhatEntered) {
  const std::vector<double> cosines = even_cosines(200);
  for (double eta : {0.5, 1.0, 1.3, 2.0, 4.0})
    for (double radius : {1e-6, 1e-2, 0.6, 5.0, 50.0, 1e4})
      for (double g : {-0.9, 0.0, 0.9})
        for (double absorption : {0.0, 1e-6, 0.1, 10.0}) {
          const BodyMedium medium{absorption * radius, radius, g};
          const std::vector<double> multiple = sphere_multiple_exitance(medium, surface_of(eta), cosines);
          for (double value : multiple) ASSERT_TRUE(std::isfinite(value) && value >= 0.0);
          // The sphere has four times the area of its shadow.
          EXPECT_LE(4.0 * mean(multiple), 1.02) << eta << ' ' << radius << ' ' << g << ' ' << absorption;
        }
}

}  // namespace
}  // namespace mesograin::physics

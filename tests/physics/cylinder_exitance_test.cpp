// The endless cylinder against photons that walk through it, its limits, and what the kernel may gather beyond a
// sphere.
#include "physics/body/cylinder_exitance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <random>

#include "physics/body/half_space_exitance.h"
#include "physics/body/sphere_exitance.h"
#include "physics/kernels/beyond_sphere.h"
#include "physics/kernels/kernel_tables.h"
#include "physics/kernels/sphere_kernel.h"
#include "physics/physics.h"

namespace mesograin::physics {
namespace {

BodySurface surface_of(double eta) { return {eta, false, diffusion_boundary(eta)}; }

BodyMedium medium_of(double albedo, double radius) { return {(1.0 - albedo) * radius, albedo * radius, 0.0}; }

// Exitance per irradiance of two scatterings and more, within a fifth of a radian of the line that faces the light.
double walked(double albedo, double radius) {
  constexpr int photons = 200000;
  constexpr double half_width = 0.2;
  std::mt19937_64 generator(20012);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  double sum = 0.0;
  for (int photon = 0; photon < photons; ++photon) {
    const double x = 2.0 * uniform(generator) - 1.0;
    glm::dvec3 place(x, std::sqrt(1.0 - x * x), 0.0);
    glm::dvec3 direction(0.0, -1.0, 0.0);
    double weight = 1.0;
    for (int order = 0; weight > 1e-4; ++order, weight *= albedo) {
      place += direction * (-std::log1p(-uniform(generator)) / radius);
      if (place.x * place.x + place.y * place.y > 1.0) {
        // Back to where it left.
        const double square = direction.x * direction.x + direction.y * direction.y;
        const double along = (place.x * direction.x + place.y * direction.y) / square;
        const double outside = (place.x * place.x + place.y * place.y - 1.0) / square;
        place -= direction * (along - std::sqrt(std::max(along * along - outside, 0.0)));
        if (order >= 2 && std::abs(std::atan2(place.x, place.y)) < half_width) sum += weight;
        break;
      }
      const double z = 2.0 * uniform(generator) - 1.0;
      const double azimuth = 2.0 * PI * uniform(generator);
      direction = glm::dvec3(sine_of_cosine(z) * std::cos(azimuth), sine_of_cosine(z) * std::sin(azimuth), z);
    }
  }
  // Light of irradiance 1 on a width of 2.
  return sum * 2.0 / photons / (2.0 * half_width);
}

TEST(CylinderExitance, IsThatOfPhotonsThatWalkThroughIt) {
  for (double radius : {0.4, 1.6, 4.0})
    for (double albedo : {0.5, 0.9}) {
      const double found = cylinder_multiple_exitance(medium_of(albedo, radius), surface_of(1.0));
      // Diffusion says least of what is scattered hardly twice.
      EXPECT_NEAR(found / walked(albedo, radius), 1.0, radius < 1.0 ? 0.14 : 0.08) << radius << ' ' << albedo;
    }
}

TEST(CylinderExitance, LiesBetweenTheSphereAsThickAndTheHalfSpace) {
  for (double eta : {1.0, 1.3})
    for (double radius : {0.2, 1.0, 5.0, 20.0}) {
      const BodyMedium medium = medium_of(0.99, radius);
      const double cylinder = cylinder_multiple_exitance(medium, surface_of(eta));
      EXPECT_GT(cylinder, sphere_multiple_exitance(medium, surface_of(eta), {1.0}).front()) << eta << ' ' << radius;
      const double half_space = half_space_multiple_exitance(medium, surface_of(eta), {1.0}).front();
      EXPECT_LT(cylinder, 1.01 * half_space) << eta << ' ' << radius;
    }
}

TEST(CylinderExitance, IsTheHalfSpacesWhereItIsThick) {
  for (bool cosine_entry : {false, true})
    for (double eta : {1.0, 1.3}) {
      BodySurface surface = surface_of(eta);
      surface.cosine_entry = cosine_entry;
      const BodyMedium medium = medium_of(0.9, 300.0);
      EXPECT_NEAR(cylinder_multiple_exitance(medium, surface) / half_space_multiple_exitance(medium, surface, {1.0})[0],
                  1.0, 0.02)
          << cosine_entry << ' ' << eta;
    }
}

TEST(CylinderExitance, HoldsAtEveryExtreme) {
  for (bool cosine_entry : {false, true})
    for (double eta : {0.5, 1.0, 1.3, 4.0})
      for (double radius : {1e-6, 1e-2, 1.0, 39.0, 1e3, 1e5})
        for (double g : {-0.999, 0.0, 0.999})
          for (double absorption : {0.0, 1e-6, 1.0, 1e3}) {
            BodySurface surface = surface_of(eta);
            surface.cosine_entry = cosine_entry;
            const double value = cylinder_multiple_exitance({absorption * radius, radius, g}, surface);
            ASSERT_TRUE(std::isfinite(value) && value >= 0.0 && value <= 1.0)
                << value << ' ' << eta << ' ' << radius << ' ' << g << ' ' << absorption;
          }
}

TEST(CylinderExitance, HasNoJumpWhereItsBesselFunctionChangesForm) {
  // The decay there is 40 inverse radii.
  const double radius = 40.0 / std::sqrt(3.0 * 0.1);
  const double below = cylinder_multiple_exitance(medium_of(0.9, radius * (1.0 - 1e-7)), surface_of(1.0));
  const double above = cylinder_multiple_exitance(medium_of(0.9, radius * (1.0 + 1e-7)), surface_of(1.0));
  EXPECT_NEAR(above / below, 1.0, 1e-5);
}

// The thinner the grain, the more of its light leaves before it has come far.
TEST(ShareBeyondSphere, FallsWithTheOpticalRadius) {
  double before = 1.0;
  for (double radius : {14.4, 7.2, 2.4, 1.2, 0.6}) {
    const BodyMedium medium = medium_of(0.9, radius);
    const SphereKernel kernel(medium, surface_of(1.0));
    const KernelTables tables = kernel_tables({&kernel, &kernel, &kernel}, surface_of(1.0), 0.05 / radius, 6.0, true);
    const glm::dvec3 share = share_beyond_sphere(tables, {medium, medium, medium}, surface_of(1.0));
    EXPECT_EQ(share.x, share.z);
    EXPECT_LE(share.x, before) << radius;
    EXPECT_GT(share.x, 0.15) << radius;
    before = share.x;
  }
  EXPECT_LT(before, 0.25);
}

}  // namespace
}  // namespace mesograin::physics

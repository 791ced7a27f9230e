// The kernels that model 3 integrates: closed totals against quadrature, limits, and tables that sample what they say.

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "physics/kernels/kernel_tables.h"
#include "physics/kernels/planar_kernel.h"
#include "physics/kernels/sphere_kernel.h"
#include "physics/physics.h"

namespace mesograin::physics {
namespace {

BodySurface surface_of(double eta) { return {eta, false, diffusion_boundary(eta)}; }

std::vector<double> geometric(double first, double last, int count) {
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) values.push_back(first * std::pow(last / first, i / (count - 1.0)));
  return values;
}

// 2 pi int R r dr by the trapezoidal rule in log r.
double plane_integral(const SurfaceKernel& kernel, double first, double last) {
  const std::vector<double> radii = geometric(first, last, 4000);
  const std::vector<double> values = kernel.evaluate(radii, 1.0);
  const double step = std::log(last / first) / 3999.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < radii.size(); ++i) sum += 2.0 * PI * radii[i] * radii[i] * values[i] * step;
  return sum;
}

TEST(PlanarKernel, IntegratesToItsClosedTotal) {
  for (double eta : {1.0, 1.3, 1.6})
    for (double absorption : {1e-3, 0.1, 0.5, 0.9}) {
      const BodyMedium medium{absorption * 3.0, (1.0 - absorption) * 3.0, 0.0};
      for (PlanarProfile profile : {PlanarProfile::dipole, PlanarProfile::better_dipole, PlanarProfile::photon_beam}) {
        const PlanarKernel kernel(profile, medium, surface_of(eta));
        EXPECT_NEAR(plane_integral(kernel, 1e-7, 300.0) / kernel.total(), 1.0, 5e-3) << eta << ' ' << absorption;
      }
    }
}

TEST(PlanarKernel, IsRescaledToTheTotalAskedFor) {
  const BodyMedium medium{0.3, 2.7, 0.0};
  const PlanarKernel kernel(PlanarProfile::photon_beam, medium, surface_of(1.3), 0.25);
  EXPECT_NEAR(kernel.total(), 0.25, 1e-12);
  EXPECT_NEAR(plane_integral(kernel, 1e-7, 300.0), 0.25, 2e-3);
}

TEST(PlanarKernel, FallsWithDistanceFarBeyondSinglePrecision) {
  for (double absorption : {0.0, 1e-8, 1e-3, 0.5, 1.0 - 1e-6}) {
    const BodyMedium medium{absorption, 1.0 - absorption, 0.0};
    for (PlanarProfile profile : {PlanarProfile::dipole, PlanarProfile::better_dipole, PlanarProfile::photon_beam}) {
      const std::vector<double> values =
          PlanarKernel(profile, medium, surface_of(1.3)).evaluate(geometric(1e-6, 400.0, 300), 1.0);
      for (std::size_t i = 0; i < values.size(); ++i) {
        ASSERT_TRUE(std::isfinite(values[i]) && values[i] > 0.0) << absorption << ' ' << i;
        if (i > 0) {
          ASSERT_LE(values[i], values[i - 1] * (1.0 + 1e-12)) << absorption << ' ' << i;
        }
      }
    }
  }
}

TEST(SphereKernel, HoldsAtEveryExtreme) {
  for (double eta : {0.5, 1.0, 1.3, 4.0})
    for (double radius : {1e-6, 1e-2, 1.0, 31.0, 33.0, 1e5})
      for (double g : {-0.999, 0.0, 0.999})
        for (double absorption : {0.0, 1e-6, 1.0, 1e3}) {
          const SphereKernel kernel({absorption * radius, radius, g}, surface_of(eta));
          for (double value : kernel.evaluate({0.0, 1e-6, 1e-2, 0.5, 2.0, 5.0}, 0.7))
            ASSERT_TRUE(std::isfinite(value) && value >= 0.0) << eta << ' ' << radius << ' ' << g << ' ' << absorption;
        }
}

TEST(SphereKernel, PassesFromTheSeriesToTheCurvedHalfSpaceWithoutAJump) {
  const std::vector<double> distances{0.0, 0.02, 0.05, 0.1};
  for (double albedo : {0.5, 0.9, 0.999})
    for (double eta : {1.0, 1.3}) {
      const auto kernel = [&](double radius) {
        return SphereKernel({(1.0 - albedo) * radius, albedo * radius, 0.0}, surface_of(eta)).evaluate(distances, 0.8);
      };
      const std::vector<double> below = kernel(31.99);
      const std::vector<double> above = kernel(32.01);
      for (std::size_t i = 0; i < distances.size(); ++i)
        EXPECT_NEAR(above[i] / below[i], 1.0, 0.01) << albedo << ' ' << eta << ' ' << distances[i];
    }
}

TEST(SphereKernel, SendsNothingWithoutScattering) {
  const SphereKernel kernel({3.0, 0.0, 0.0}, surface_of(1.3));
  for (double value : kernel.evaluate({0.0, 0.1, 1.0}, 1.0)) EXPECT_EQ(value, 0.0);
}

// Sampling by the inverse and weighing by its density must give back the kernel's own integral.
TEST(KernelTables, SampleWhatTheyHold) {
  for (double radius : {0.5, 5.0, 100.0}) {
    const PlanarKernel kernel(PlanarProfile::better_dipole, {0.1 * radius, 0.9 * radius, 0.0}, surface_of(1.3));
    const KernelTables tables = kernel_tables({&kernel, &kernel, &kernel}, surface_of(1.3), 0.05 / radius, 6.0, false);
    double sum = 0.0;
    constexpr int samples = 20000;
    for (int i = 0; i < samples; ++i) {
      const double depth = -std::log1p(-(i + 0.5) / samples);
      // The nearest entry, as in gather in shaders/models/model_3.glsl.
      const double column = std::sqrt(depth / tables.largest_depth) * (tables.inverse.width - 1);
      const glm::dvec4 drawn(tables.inverse.texels[static_cast<std::size_t>(std::lround(column))]);
      sum += kernel.evaluate({drawn.x}, 1.0).front() / drawn.y / samples;
    }
    EXPECT_NEAR(sum / plane_integral(kernel, 1e-6 / radius, 6.0), 1.0, 3e-3) << radius;
  }
}

// What is met is as far as what was drawn, or farther: no sample may weigh much more than the light that is there.
TEST(KernelTables, DrawNothingMoreRarelyThanItIsMet) {
  for (double radius : {0.1, 0.6, 2.4, 7.2, 40.0})
    for (double g : {-0.5, 0.0, 0.3, 0.5, 0.9}) {
      const SphereKernel kernel({0.1 * radius, 0.9 * radius, g}, surface_of(1.3));
      const KernelTables tables = kernel_tables({&kernel, &kernel, &kernel}, surface_of(1.3), 0.05 / radius, 2.0, true);
      const int width = tables.profile.width;
      for (int k = 0; k < tables.inverse.width; ++k) {
        const glm::dvec4 drawn(tables.inverse.texels[static_cast<std::size_t>(k)]);
        ASSERT_GT(drawn.y, 0.0) << radius << ' ' << g << ' ' << k;
        const int first =
            static_cast<int>(std::ceil(kernel_column(drawn.x, 1.0 / tables.shortest, tables.columns_per_octave())));
        for (int i = 0; i < tables.profile.height; ++i)
          for (int j = std::min(first, width - 1); j < width; ++j)
            ASSERT_LT(tables.profile.texels[static_cast<std::size_t>(i * width + j)].r / drawn.y, 8.0)
                << radius << ' ' << g << ' ' << k << ' ' << i << ' ' << j;
      }
    }
}

}  // namespace
}  // namespace mesograin::physics

// The slab against van de Hulst's tabulated solution, energy, and the half-space that a thick one is.
#include "slab.h"

#include <gtest/gtest.h>

#include <cmath>

#include "chandrasekhar.h"

namespace mesograin::referee {
namespace {

constexpr int sigmas = 5;

TEST(Slab, AgreesWithVanDeHulst) {
  // van de Hulst, "Multiple light scattering", 1980, table 35: thickness 2, albedo .9, g .75, no interface.
  const SlabResult result = trace_slab({.thickness = 2, .g = 0.75, .albedos = {0.9}}, {600'000, 61, 0});
  EXPECT_NEAR(result.reflected.scattered[0].value, 0.09739, sigmas * result.reflected.scattered[0].noise);
  EXPECT_NEAR(result.transmitted.scattered[0].value + result.transmitted.ballistic.value, 0.66096,
              sigmas * result.transmitted.scattered[0].noise);
  EXPECT_NEAR(result.transmitted.ballistic.value, std::exp(-2.0), sigmas * result.transmitted.ballistic.noise);
}

TEST(Slab, WithoutAbsorptionNothingIsLost) {
  for (double eta : {1.0, 1.5}) {
    const SlabResult result =
        trace_slab({.thickness = 3, .eta = eta, .incidence = {.diffuse = true}, .albedos = {1}}, {300'000, 62, 0});
    const double sum = result.reflected.scattered[0].value + result.transmitted.scattered[0].value +
                       result.reflected.ballistic.value + result.transmitted.ballistic.value;
    EXPECT_NEAR(sum, 1, 0.005) << "eta " << eta;
  }
}

TEST(Slab, AThickOneIsAHalfSpace) {
  const SlabResult result = trace_slab({.thickness = 60, .albedos = {0.8}}, {400'000, 63, 0});
  EXPECT_NEAR(result.reflected.scattered[0].value, ChandrasekharH(0.8).plane_albedo(1),
              sigmas * result.reflected.scattered[0].noise);
  EXPECT_LT(result.transmitted.scattered[0].value, 1e-9);
}

}  // namespace
}  // namespace mesograin::referee

// Grains of many colours: classes of a few materials are near enough to each grain's own, and keep the mean.
#include "scene/colour_classes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>

#include "expect_error.h"
#include "scene/sphere.h"

namespace mesograin::scene {
namespace {

using test::expect_error;

InstanceArray varied(Model model, std::size_t count, ColourFactors factors) {
  static const MeshPointer mesh = std::make_shared<const Mesh>(unit_sphere());
  std::vector<glm::dmat4> places;
  for (std::size_t i = 0; i < count; ++i)
    places.push_back(glm::translate(glm::dmat4(1.0), {static_cast<double>(i), 0.0, 0.0}));
  Material material;
  material.model = model;
  material.sigma_a = glm::dvec3(0.5);
  material.reflectance = glm::dvec3(0.8);
  return {mesh, material, Transforms(places), std::move(factors)};
}

/// The material that an instance got, by its place.
Material of_instance(const std::vector<InstanceArray>& classes, std::size_t instance) {
  for (const InstanceArray& one : classes)
    for (const glm::dmat4 place : one.object_to_world())
      if (place[3].x == static_cast<double>(instance)) return one.material;
  ADD_FAILURE() << "instance " << instance << " is in no class";
  return {};
}

TEST(ColourClasses, EachInstanceIsOfNearlyItsColour) {
  constexpr std::size_t count = 1000;
  ColourFactors factors;
  factors.sigma_a = random_factors(glm::dvec3(0.5, 1.0, 2.0), glm::dvec3(2.0, 1.0, 0.5), count, 7);
  for (const auto& [model, most] : {std::pair{Model::model_2, 16}, {Model::lambert, 32}}) {
    const InstanceArray array = varied(model, count, factors);
    const std::vector<InstanceArray> classes = by_colour({array});
    EXPECT_LE(static_cast<int>(classes.size()), most);
    glm::dvec3 mean(0.0);
    glm::dvec3 exact(0.0);
    double worst = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const glm::dvec3 own = array.material.sigma_a * glm::dvec3(factors.sigma_a[i]);
      const glm::dvec3 got = of_instance(classes, i).sigma_a;
      for (int channel = 0; channel < 3; ++channel)
        worst = std::max(worst, std::abs(std::log(got[channel] / own[channel])));
      mean += got;
      exact += own;
    }
    EXPECT_LT(worst, 2.0 * std::log(4.0) / most) << "of a range of four to one";
    for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(mean[channel] / exact[channel], 1.0, 1e-6);
  }
}

TEST(ColourClasses, FewColoursAreExact) {
  ColourFactors factors;
  for (int i = 0; i < 30; ++i) factors.reflectance.emplace_back(0.25F * static_cast<float>(i % 3 + 1), 1.0F, 0.5F);
  const std::vector<InstanceArray> classes = by_colour({varied(Model::lambert, 30, factors)});
  ASSERT_EQ(classes.size(), 3U);
  for (std::size_t i = 0; i < 30; ++i)
    EXPECT_NEAR(of_instance(classes, i).reflectance.r, 0.8 * 0.25 * static_cast<double>(i % 3 + 1), 1e-7);
}

TEST(ColourClasses, WithoutFactorsAnArrayStaysWhole) {
  const InstanceArray array = varied(Model::model_2, 10, {});
  const std::vector<InstanceArray> same = by_colour({array});
  ASSERT_EQ(same.size(), 1U);
  EXPECT_EQ(&same[0].object_to_world(), &array.object_to_world()) << "not even copied";
}

TEST(ColourClasses, ArraysOfOneMaterialShareTheirColours) {
  constexpr std::size_t count = 300;
  const auto factors = [](unsigned seed) {
    ColourFactors some;
    some.sigma_a = random_factors(glm::dvec3(0.5), glm::dvec3(2.0), count, seed);
    return some;
  };
  InstanceArray other = varied(Model::model_2, count, factors(9));
  other.material.sigma_s *= 2.0;
  const InstanceArray plain = varied(Model::model_2, 5, {});
  const std::vector<InstanceArray> arrays{varied(Model::model_2, count, factors(7)), plain,
                                          varied(Model::model_2, count, factors(8)), other};
  const std::vector<InstanceArray> classes = by_colour(arrays);
  EXPECT_EQ(&classes.front().object_to_world(), &plain.object_to_world()) << "what has no factors comes first";

  std::vector<Material> materials;
  std::size_t instances = 0;
  glm::dvec3 sum(0.0);
  for (const InstanceArray& one : classes) {
    instances += one.object_to_world().size();
    if (one.material.sigma_s != plain.material.sigma_s || one.material == plain.material) continue;
    sum += static_cast<double>(one.object_to_world().size()) * one.material.sigma_a;
    if (std::ranges::find(materials, one.material) == materials.end()) materials.push_back(one.material);
  }
  EXPECT_EQ(instances, 3 * count + 5);
  EXPECT_LE(materials.size(), 16U) << "of both together";
  glm::dvec3 exact(0.0);
  for (const std::size_t array : {0, 2})
    for (const glm::vec3 factor : arrays[array].factors().sigma_a) exact += 0.5 * glm::dvec3(factor);
  for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(sum[channel] / exact[channel], 1.0, 1e-6);
}

TEST(ColourClasses, FactorsThatDoNotFitAreRefused) {
  ColourFactors factors;
  factors.sigma_a = {glm::vec3(1.0F)};
  Scene scene;
  scene.arrays.push_back(varied(Model::model_2, 2, factors));
  expect_error([&] { validate(scene); }, "factors of sigma_a must be one for each of the 2 instances; got 1");
  factors.sigma_a = {glm::vec3(1.0F), glm::vec3(1.0F, -1.0F, 1.0F)};
  scene.arrays = {varied(Model::model_2, 2, factors)};
  expect_error([&] { validate(scene); }, "must be finite and at least 0; got -1");
}

}  // namespace
}  // namespace mesograin::scene

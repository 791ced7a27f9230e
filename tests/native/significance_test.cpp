// The significance test on noise whose distribution is known: its false alarms, and what it finds.
#include "image/significance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "expect_error.h"

namespace mesograin::image {
namespace {

using test::expect_error;

constexpr int side = 48;

Mask everywhere() { return {side, side, std::vector<std::uint8_t>(side * side, 1)}; }

// A horizontal gradient from 0.2 to 1.2: the truth.
double truth(int x) { return 0.2 + static_cast<double>(x) / side; }

Image exact(double factor = 1.0) {
  Image image{side, side, 3, std::vector<float>(side * side * 3)};
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = static_cast<float>(factor * truth(static_cast<int>(i / 3 % side)));
  return image;
}

// Noise as that of Monte Carlo: its variance follows the mean.
Image noisy(std::mt19937& random, double relative_noise) {
  std::normal_distribution<double> normal;
  Image image = exact();
  for (float& value : image.pixels) value += static_cast<float>(relative_noise * std::sqrt(value) * normal(random));
  return image;
}

Significance run(const Image& image, unsigned seed, int seeds, double relative_noise, double rate = 0.01) {
  std::mt19937 random(seed);
  std::vector<Image> images;
  images.reserve(static_cast<std::size_t>(seeds));
  for (int i = 0; i < seeds; ++i) images.push_back(noisy(random, relative_noise));
  std::vector<ImageView> views;
  views.reserve(images.size());
  for (const Image& reference : images) views.push_back(reference.view());
  return test_significance({image.view()}, views, everywhere(), {rate, 0.002});
}

TEST(Significance, FalseAlarmsComeAtTheStatedRate) {
  // At a stated rate of 0.2, 200 trials give 40 +- 5.7; the tolerance can only lower the rate.
  int alarms = 0;
  for (unsigned trial = 0; trial < 200; ++trial) alarms += run(exact(), trial, 4, 0.2, 0.2).differs ? 1 : 0;
  EXPECT_GE(alarms, 15);
  EXPECT_LE(alarms, 62);
}

TEST(Significance, TwoSeedsSufficeToStayQuiet) {
  int alarms = 0;
  for (unsigned trial = 0; trial < 100; ++trial) alarms += run(exact(), 1000 + trial, 2, 0.2, 0.05).differs ? 1 : 0;
  EXPECT_LE(alarms, 14);
}

// `images` noisy renders of the truth, darkened by `factor`, against four of another noise.
Significance run_noisy(unsigned seed, int images, double image_noise, double rate, double factor = 1.0) {
  std::mt19937 random(seed);
  std::vector<Image> rendered;
  rendered.reserve(static_cast<std::size_t>(images) + 4);
  for (int i = 0; i < images; ++i) rendered.push_back(noisy(random, image_noise));
  for (Image& image : rendered)
    for (float& value : image.pixels) value *= static_cast<float>(factor);
  for (int i = 0; i < 4; ++i) rendered.push_back(noisy(random, 0.1));
  std::vector<ImageView> views;
  views.reserve(rendered.size());
  for (const Image& image : rendered) views.push_back(image.view());
  const auto first = views.begin() + images;
  return test_significance({views.begin(), first}, {first, views.end()}, everywhere(), {rate, 0.002});
}

TEST(Significance, TheNoiseOfTheImageCounts) {
  // 60 trials at a rate of 0.2 give 12 +- 3; the tolerance can only lower the rate. The same image taken for exact is
  // called different every time.
  for (const double image_noise : {0.02, 0.3}) {
    int alarms = 0;
    for (unsigned trial = 0; trial < 60; ++trial) alarms += run_noisy(500 + trial, 4, image_noise, 0.2).differs ? 1 : 0;
    EXPECT_GE(alarms, 2) << image_noise;
    EXPECT_LE(alarms, 24) << image_noise;
  }
  EXPECT_TRUE(run_noisy(1, 1, 0.3, 0.01).differs);
  EXPECT_TRUE(run_noisy(1, 4, 0.1, 0.01, 0.5).differs);
}

// Noise as that of few light paths, each bright or dark: a gamma distribution, whose excess kurtosis is 6 / shape.
Image skewed(std::mt19937& random, double shape) {
  std::gamma_distribution<double> gamma(shape, 1.0 / shape);
  Image image = exact();
  for (float& value : image.pixels) value *= static_cast<float>(gamma(random));
  return image;
}

// Whether `count` images of that noise, brightened by a factor, differ from two at a rate of 1 %.
bool skewed_differs(unsigned seed, int count, double shape, double factor) {
  std::mt19937 random(seed);
  std::vector<Image> rendered;
  rendered.reserve(static_cast<std::size_t>(count) + 2);
  for (int i = 0; i < count + 2; ++i) {
    rendered.push_back(skewed(random, shape));
    if (i < count)
      for (float& value : rendered.back().pixels) value *= static_cast<float>(factor);
  }
  std::vector<ImageView> views;
  views.reserve(rendered.size());
  for (const Image& image : rendered) views.push_back(image.view());
  const auto first = views.begin() + count;
  return test_significance({views.begin(), first}, {first, views.end()}, everywhere(), {0.01, 0.002}).differs;
}

TEST(Significance, HeavyTailsOfTheNoiseAreNoAlarms) {
  // 150 trials at a rate of 1 % give 1.5 +- 1.2; taken for normal, such noise gives 36 with two images, 41 with four.
  for (const int count : {2, 4}) {
    int alarms = 0;
    for (unsigned trial = 0; trial < 150; ++trial) alarms += skewed_differs(3000 + trial, count, 4.0, 1.0) ? 1 : 0;
    EXPECT_LE(alarms, 5) << count;
  }
  EXPECT_TRUE(skewed_differs(1, 4, 4.0, 3.0)) << "what is wrong is still found";
}

TEST(Significance, AWrongImageIsFound) {
  const Significance result = run(exact(1.3), 5, 4, 0.05);
  EXPECT_TRUE(result.differs);
  EXPECT_GT(result.significant_pixels, side * side / 2);
  EXPECT_GT(result.score.pixels[0], 0.0F) << "too bright is positive";
  EXPECT_LT(run(exact(0.7), 5, 4, 0.05).score.pixels[0], 0.0F);
}

TEST(Significance, OneWrongPixelIsFoundWhereItIs) {
  Image image = exact();
  image.pixels[(20 * side + 30) * 3 + 1] *= 2.0F;
  const Significance result = run(image, 6, 4, 0.05);
  EXPECT_TRUE(result.differs);
  EXPECT_LT(result.p_value.pixels[20 * side + 30], result.threshold);
  EXPECT_GE(result.p_value.pixels[21 * side + 30], result.threshold);
}

TEST(Significance, ADifferenceWithinTheToleranceIsNone) {
  EXPECT_FALSE(run(exact(1.0015), 7, 4, 1e-5).differs);
  EXPECT_TRUE(run(exact(1.004), 7, 4, 1e-5).differs);
  EXPECT_FALSE(run(exact(), 7, 2, 0.0).differs);
  EXPECT_TRUE(run(exact(1.01), 7, 2, 0.0).differs);
}

TEST(Significance, TheThresholdIsSidaks) {
  const Significance result = run(exact(), 8, 2, 0.1);
  EXPECT_EQ(result.tests, side * side * 3);
  EXPECT_NEAR(std::pow(1.0 - result.threshold, static_cast<double>(result.tests)), 0.99, 1e-9);
  EXPECT_NEAR(std::erfc(result.score_threshold / std::sqrt(2.0)), result.threshold, 1e-12);
}

TEST(Significance, NotANumberIsNotTested) {
  Image image = exact();
  image.pixels[0] = std::numeric_limits<float>::quiet_NaN();
  const Significance result = run(image, 9, 4, 0.05);
  EXPECT_EQ(result.tests, (side * side - 1) * 3);
  EXPECT_EQ(result.p_value.pixels[0], 1.0F);
}

TEST(Significance, WhatCannotBeTestedIsSaid) {
  const Image image = exact();
  expect_error([&] { test_significance({image.view()}, {image.view()}, everywhere()); }, "two or more references");
  expect_error([&] { test_significance({}, {image.view(), image.view()}, everywhere()); }, "at least one image");
  const Image small{8, 8, 3, std::vector<float>(8 * 8 * 3)};
  expect_error([&] { test_significance({image.view()}, {image.view(), small.view()}, everywhere()); }, "one shape");
  const Mask nothing{side, side, std::vector<std::uint8_t>(side * side, 0)};
  expect_error(
      [&] {
        test_significance({image.view()}, {image.view(), image.view()}, nothing);
      },
      "at least one masked");
}

}  // namespace
}  // namespace mesograin::image

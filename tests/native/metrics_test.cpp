// Metrics against values worked out by hand; the Python tests hold them against numpy and OpenImageIO.
#include "image/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "expect_error.h"

namespace mesograin::image {
namespace {

using test::expect_error;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

Image grey(int width, int height, std::vector<float> pixels) {
  return {.width = width, .height = height, .channels = 1, .pixels = std::move(pixels)};
}

Image constant(int width, int height, int channels, float value) {
  return {.width = width,
          .height = height,
          .channels = channels,
          .pixels = std::vector<float>(static_cast<std::size_t>(width * height * channels), value)};
}

TEST(Metrics, DefinitionsOnTwoPixels) {
  const Image image = grey(2, 1, {1.0F, 2.0F});
  const Image reference = grey(2, 1, {2.0F, 0.5F});
  const Comparison result = compare(image.view(), {reference.view()});
  EXPECT_DOUBLE_EQ(result.e_mean, 0.25);
  EXPECT_DOUBLE_EQ(result.bias, 3.0 / 2.5);
  EXPECT_DOUBLE_EQ(result.max_error, 1.5);
  EXPECT_EQ(result.max_error_at.x, 1);
  EXPECT_DOUBLE_EQ(result.pixels.ae_mean, 1.25);
  EXPECT_DOUBLE_EQ(result.pixels.se_mean, (1.0 + 2.25) / 2.0);
  EXPECT_DOUBLE_EQ(result.pixels.mse, result.pixels.se_mean);
  EXPECT_DOUBLE_EQ(result.pixels.rmse, std::sqrt(1.625));
  EXPECT_DOUBLE_EQ(result.pixels.rae_mean, (1.0 / 2.01 + 1.5 / 0.51) / 2.0);
  const double rse_0 = 1.0 / 4.01, rse_1 = 2.25 / 0.26;
  EXPECT_DOUBLE_EQ(result.pixels.rse_mean, (rse_0 + rse_1) / 2.0);
  EXPECT_DOUBLE_EQ(result.pixels.rse_root_mean, (std::sqrt(rse_0) + std::sqrt(rse_1)) / 2.0);
  EXPECT_DOUBLE_EQ(result.pixels.relative_l1, 2.5 / 2.5);
  EXPECT_DOUBLE_EQ(result.rse_max, rse_1);
  EXPECT_DOUBLE_EQ(result.rse.p50, (rse_0 + rse_1) / 2.0);
  EXPECT_DOUBLE_EQ(result.rse.p95, rse_0 + 0.95 * (rse_1 - rse_0));
  EXPECT_EQ(result.mask.source, "all pixels");
  EXPECT_EQ(result.mask.pixels, 2);
  EXPECT_FALSE(result.noise_floor.has_value());
  // Both pixels are in one block, so only their mean counts there.
  EXPECT_DOUBLE_EQ(result.blocks.relative_l1, 0.25 / 1.25);
}

TEST(Metrics, NoiseFloorOfTwoReferences) {
  const Image image = grey(2, 1, {1.0F, 1.0F});
  const Image a = grey(2, 1, {0.5F, 2.0F});
  const Image b = grey(2, 1, {1.5F, 1.0F});
  const Comparison result = compare(image.view(), {a.view(), b.view()});
  ASSERT_TRUE(result.noise_floor.has_value());
  EXPECT_DOUBLE_EQ(result.noise_floor->relative_l1, 0.5 * 2.0 / 2.5);
  EXPECT_DOUBLE_EQ(result.noise_floor->rse_mean, 0.25 * (1.0 / 1.01 + 1.0 / 2.26) / 2.0);
  EXPECT_DOUBLE_EQ(result.pixels.relative_l1, 0.5 / 2.5);
  EXPECT_DOUBLE_EQ(result.noise_floor_blocks->relative_l1, 0.0);
  const Errors corrected = correct_for_noise(result.pixels, *result.noise_floor);
  EXPECT_EQ(corrected.relative_l1, 0.0) << "below the floor nothing is left";
}

TEST(Metrics, NoiseFloorOfManyReferencesIsTheErrorOfTheirMean) {
  // What a perfect image scores against the mean of K noisy renders is the floor that those renders tell by themselves.
  std::mt19937 generator(4);
  std::normal_distribution<float> noise(0.0F, 0.05F);
  const Image truth = constant(120, 120, 3, 1.0F);
  for (const std::size_t count : {2U, 3U, 8U}) {
    std::vector<Image> seeds(count, truth);
    std::vector<ImageView> views;
    for (Image& seed : seeds) {
      for (float& value : seed.pixels) value += noise(generator);
      views.push_back(seed.view());
    }
    const Comparison result = compare(truth.view(), views);
    const double deviation = 0.05 / std::sqrt(static_cast<double>(count));
    EXPECT_NEAR(result.noise_floor->rmse, deviation, 0.02 * deviation);
    EXPECT_NEAR(result.noise_floor->relative_l1, std::sqrt(2.0 / 3.14159265) * deviation, 0.02 * deviation);
    for (const ErrorsMember& member : errors_members) {
      const double perfect = result.pixels.*member.value;
      EXPECT_NEAR((*result.noise_floor).*member.value, perfect, 0.03 * perfect) << member.name;
      const double perfect_blocks = result.blocks.*member.value;
      EXPECT_NEAR((*result.noise_floor_blocks).*member.value, perfect_blocks, 0.12 * perfect_blocks) << member.name;
    }
  }
}

TEST(Metrics, NoReferenceIsSaid) {
  const Image image = constant(4, 4, 3, 1.0F);
  expect_error([&] { compare(image.view(), {}); }, "at least one reference");
}

TEST(Metrics, CorrectionTakesTheNoiseOff) {
  // A biased image against two noisy renders of a constant: the raw error holds the noise, the corrected one does not.
  std::mt19937 generator(3);
  std::normal_distribution<float> noise(0.0F, 0.2F);
  const auto noisy = [&] {
    Image image = constant(200, 200, 3, 1.0F);
    for (float& value : image.pixels) value += noise(generator);
    return image;
  };
  const Image image = constant(200, 200, 3, 1.1F), a = noisy(), b = noisy();
  const Comparison result = compare(image.view(), {a.view(), b.view()});
  const Errors corrected = correct_for_noise(result.pixels, *result.noise_floor);
  EXPECT_GT(result.pixels.mse, 0.029);
  EXPECT_NEAR(corrected.mse, 0.01, 3e-4);
  EXPECT_NEAR(corrected.rmse, 0.1, 2e-3);
  EXPECT_NEAR(result.blocks.relative_l1, 0.1, 2e-3);
  EXPECT_NEAR(result.bias, 1.1, 2e-3);
}

TEST(Metrics, NanAndInfAreCountedAndLeftOut) {
  const Image image = grey(5, 1, {1.0F, nan, infinity, 3.0F, 1.0F});
  const Image reference = grey(5, 1, {2.0F, infinity, 1.0F, nan, 1.0F});
  const Comparison result = compare(image.view(), {reference.view()});
  EXPECT_EQ(result.mask.pixels, 5);
  EXPECT_EQ(result.mask.nan, 2);
  EXPECT_EQ(result.mask.inf, 1);
  EXPECT_EQ(result.mask.used, 2);
  EXPECT_EQ(result.mask.image_not_finite, 2);
  EXPECT_DOUBLE_EQ(result.pixels.ae_mean, 0.5);
  const Image errors = error_image(image.view(), {reference.view()}, ErrorMetric::ae);
  EXPECT_EQ(errors.pixels[0], 1.0F);
  EXPECT_TRUE(std::isnan(errors.pixels[3]));
}

TEST(Metrics, ABlackReferenceHasNoRelativeValues) {
  const Image black = constant(4, 4, 3, 0.0F);
  const Comparison result = compare(constant(4, 4, 3, 1.0F).view(), {black.view(), black.view()});
  EXPECT_TRUE(std::isnan(result.bias));
  EXPECT_TRUE(std::isnan(result.pixels.relative_l1));
  EXPECT_TRUE(std::isnan(correct_for_noise(result.pixels, *result.noise_floor).relative_l1));
  EXPECT_DOUBLE_EQ(result.pixels.rse_mean, 100.0);
}

TEST(Metrics, TheMaskDecides) {
  const Image image = grey(2, 1, {1.0F, 9.0F});
  const Image reference = grey(2, 1, {1.0F, 1.0F});
  const Comparison result = compare(image.view(), {reference.view()}, Mask{.width = 2, .height = 1, .pixels = {1, 0}});
  EXPECT_EQ(result.mask.source, "given");
  EXPECT_EQ(result.mask.pixels, 1);
  EXPECT_EQ(result.max_error, 0.0);
}

TEST(Metrics, CoverageIsTheDefaultMask) {
  Image reference = constant(9, 9, 4, 1.0F);
  reference.pixels[(4 * 9 + 4) * 4 + 3] = 0.5F;  // the middle is half covered
  const Comparison result = compare(constant(9, 9, 3, 1.0F).view(), {reference.view()});
  EXPECT_EQ(result.mask.source, "reference coverage");
  EXPECT_EQ(result.mask.pixels, 81 - 13) << "a disc of radius 2 has 13 pixels";
}

TEST(Metrics, ErosionIsADiscAndTheBorderDoesNotErode) {
  std::mt19937 generator(11);
  for (int erode = 0; erode < 6; ++erode) {
    Image coverage = constant(31, 23, 1, 1.0F);
    for (int hole = 0; hole < 5; ++hole) coverage.pixels[generator() % coverage.pixels.size()] = hole ? 0.3F : nan;
    const Mask mask = default_mask(coverage.view(), erode);
    for (int y = 0; y < 23; ++y)
      for (int x = 0; x < 31; ++x) {
        bool expected = true;
        for (int other_y = 0; other_y < 23; ++other_y)
          for (int other_x = 0; other_x < 31; ++other_x)
            if (!(*coverage.view().at(other_x, other_y) >= 1.0F) &&
                (other_x - x) * (other_x - x) + (other_y - y) * (other_y - y) <= erode * erode)
              expected = false;
        ASSERT_EQ(mask.pixels[y * 31 + x] != 0, expected) << x << ", " << y << ", erode " << erode;
      }
  }
}

TEST(Metrics, BlocksWeighByTheirPixels) {
  // 9 x 1 pixels are a block of 8 and a block of 1: errors that cancel in the first vanish, the last one stays.
  const Image image = grey(9, 1, {2, 0, 2, 0, 2, 0, 2, 0, 3});
  const Image reference = constant(9, 1, 1, 1.0F);
  const Comparison result = compare(image.view(), {reference.view()});
  EXPECT_DOUBLE_EQ(result.blocks.relative_l1, 2.0 / 9.0);
  EXPECT_DOUBLE_EQ(result.blocks.mse, 4.0 / 9.0);
  EXPECT_DOUBLE_EQ(result.pixels.relative_l1, 10.0 / 9.0);
}

TEST(Metrics, MistakesAreNamed) {
  const Image image = constant(4, 4, 3, 1.0F);
  expect_error([&] { compare(image.view(), {constant(4, 5, 3, 1.0F).view()}); }, "4 x 4 and 4 x 5");
  expect_error([&] { compare(image.view(), {constant(4, 4, 1, 1.0F).view()}); }, "both be grey or both be RGB");
  expect_error([&] { compare(constant(4, 4, 2, 1.0F).view(), {image.view()}); }, "1, 3 or 4 channels; got 2");
  expect_error([&] { compare(image.view(), {constant(4, 4, 3, nan).view()}); }, "None of the 16 masked pixels");
  expect_error(
      [&] {
        compare(image.view(), {image.view()},
                Mask{.width = 4, .height = 4, .pixels = std::vector<std::uint8_t>(16, 0)});
      },
      "selects no pixel");
  expect_error([&] { compare(image.view(), {image.view()}, Mask{.width = 1, .height = 1, .pixels = {1}}); },
               "must have the image's size");
  expect_error([&] { default_mask(image.view()); }, "one channel; got 3");
  expect_error([&] { default_mask(constant(2, 2, 1, 1.0F).view(), -1); }, "0 or more");
  expect_error([&] { parse_error_metric("psnr"); }, "e, ae, se, rae, rse, rse_root; got 'psnr'");
}

}  // namespace
}  // namespace mesograin::image

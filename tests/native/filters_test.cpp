// The masks of a comparison on errors whose outliers are known.
#include "image/filters.h"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "expect_error.h"

namespace mesograin::image {
namespace {

using test::expect_error;

Mask all(int width, int height) {
  return {width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(width * height), 1)};
}

int count(const Mask& mask) { return std::accumulate(mask.pixels.begin(), mask.pixels.end(), 0); }

TEST(Filters, CropKeepsTheRectangle) {
  const Mask cropped = crop_mask(all(8, 6), 2, 1, 5, 4);
  EXPECT_EQ(count(cropped), 9);
  EXPECT_EQ(cropped.pixels[1 * 8 + 2], 1);
  EXPECT_EQ(cropped.pixels[4 * 8 + 2], 0);
  Mask hole = all(8, 6);
  hole.pixels[1 * 8 + 2] = 0;
  EXPECT_EQ(count(crop_mask(hole, 2, 1, 5, 4)), 8);
  expect_error([] { crop_mask(all(8, 6), 2, 1, 9, 4); }, "inside 8 x 6 pixels; got 2 1 9 4");
}

TEST(Filters, MeanDeviationTakesTheOutliers) {
  Image error{10, 10, 1, std::vector<float>(100, 1.0F)};
  error.pixels[17] = 100.0F;
  const Mask kept = mean_deviation_mask(error.view(), all(10, 10));
  EXPECT_EQ(count(kept), 99);
  EXPECT_EQ(kept.pixels[17], 0);
}

TEST(Filters, MeanDeviationThresholdIsMeanPlusDeviation) {
  // 0, 1, ..., 99 have mean 49.5 and standard deviation 28.866, so 79 is the first to go.
  Image error{10, 10, 1, std::vector<float>(100)};
  std::iota(error.pixels.begin(), error.pixels.end(), 0.0F);
  EXPECT_EQ(count(mean_deviation_mask(error.view(), all(10, 10))), 79);
}

TEST(Filters, NotANumberStaysSoThatItIsCounted) {
  Image error{10, 10, 1, std::vector<float>(100, 1.0F)};
  error.pixels[3] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(mean_deviation_mask(error.view(), all(10, 10)).pixels[3], 1);
  EXPECT_EQ(otsu_mask(error.view(), all(10, 10)).pixels[3], 1);
}

TEST(Filters, OtsuPartsTwoClasses) {
  Image error{16, 16, 3, std::vector<float>(16 * 16 * 3)};
  for (std::size_t y = 0; y < 16; ++y)
    for (std::size_t x = 0; x < 16; ++x)
      for (std::size_t channel = 0; channel < 3; ++channel)
        error.pixels[(y * 16 + x) * 3 + channel] =
            (x >= 12 ? 5.0F : 0.1F) + 0.01F * static_cast<float>((x * 7 + y * 3) % 5);
  const Mask kept = otsu_mask(error.view(), all(16, 16), 1);
  EXPECT_EQ(count(kept), 12 * 16);
  EXPECT_EQ(kept.pixels[5 * 16 + 11], 1);
  EXPECT_EQ(kept.pixels[5 * 16 + 12], 0);
}

TEST(Filters, TheMedianSparesALonelyPixel) {
  Image error{16, 16, 1, std::vector<float>(16 * 16, 0.1F)};
  for (std::size_t y = 0; y < 16; ++y)
    for (std::size_t x = 12; x < 16; ++x) error.pixels[y * 16 + x] = 5.0F;
  error.pixels[8 * 16 + 4] = 5.0F;
  EXPECT_EQ(otsu_mask(error.view(), all(16, 16), 4).pixels[8 * 16 + 4], 1);
  EXPECT_EQ(otsu_mask(error.view(), all(16, 16), 1).pixels[8 * 16 + 4], 0);
}

TEST(Filters, EqualErrorsLoseNothing) {
  const Image error{8, 8, 1, std::vector<float>(64, 0.5F)};
  EXPECT_EQ(count(otsu_mask(error.view(), all(8, 8))), 64);
  EXPECT_EQ(count(mean_deviation_mask(error.view(), all(8, 8))), 64);
}

}  // namespace
}  // namespace mesograin::image

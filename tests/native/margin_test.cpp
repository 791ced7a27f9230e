// The margin of a texture against one filled by hand.
#include "image/margin.h"

#include <gtest/gtest.h>

#include <vector>

#include "expect_error.h"

namespace mesograin::image {
namespace {

/// A row of texels with (value, coverage) each; the value is in all three colours.
std::vector<float> row(const std::vector<std::pair<float, float>>& texels) {
  std::vector<float> pixels;
  for (const auto& [value, coverage] : texels) pixels.insert(pixels.end(), {value, value, value, coverage});
  return pixels;
}

std::vector<float> extended(const std::vector<float>& pixels, int width, int height, int margin) {
  return extend_margin({pixels.data(), width, height, 4}, margin).pixels;
}

TEST(MarginTest, GrowsByItsTexelsAndNoFarther) {
  const std::vector<float> pixels = row({{0, 0}, {0, 0}, {0, 0}, {5, 1}, {0, 0}});
  EXPECT_EQ(extended(pixels, 5, 1, 1), row({{0, 0}, {0, 0}, {5, 1}, {5, 1}, {5, 1}}));
  EXPECT_EQ(extended(pixels, 5, 1, 2), row({{0, 0}, {5, 1}, {5, 1}, {5, 1}, {5, 1}}));
}

TEST(MarginTest, TexelsCoveredInPartBecomeFull) {
  EXPECT_EQ(extended(row({{2, 0.25F}, {6, 1}}), 2, 1, 1), row({{8, 1}, {6, 1}}));
}

TEST(MarginTest, EmptyTexelsTakeTheMeanOfAllNeighbours) {
  EXPECT_EQ(extended(row({{1, 1}, {0, 0}, {3, 1}}), 3, 1, 9), row({{1, 1}, {2, 1}, {3, 1}}));
  // Eight around one.
  std::vector<float> ring;
  for (int i = 0; i < 9; ++i) {
    const float value = i == 4 ? 0.0F : static_cast<float>(i);
    ring.insert(ring.end(), {value, value, value, i == 4 ? 0.0F : 1.0F});
  }
  EXPECT_FLOAT_EQ(extended(ring, 3, 3, 1)[16], 4.0F);
}

TEST(MarginTest, ZeroIsTheTextureItself) {
  const std::vector<float> pixels = row({{2, 0.25F}, {0, 0}});
  EXPECT_EQ(extended(pixels, 2, 1, 0), pixels);
}

TEST(MarginTest, AnEmptyTextureStaysEmpty) {
  const std::vector<float> pixels = row({{0, 0}, {0, 0}});
  EXPECT_EQ(extended(pixels, 2, 1, 30000), pixels);
}

TEST(MarginTest, WhatIsNoTextureIsSaid) {
  const std::vector<float> pixels(12);
  test::expect_error([&] { extend_margin({pixels.data(), 2, 2, 3}, 1); }, "4 channels, the last its coverage; got 3");
  test::expect_error(
      [&] {
        extend_margin({pixels.data(), 3, 1, 4}, -1);
      },
      "margin must lie between 0 and 32767; got -1");
}

}  // namespace
}  // namespace mesograin::image

// Whole heaps against what is known of them otherwise: truth by another path tracer (tests/data/heaps), and energy.
#include "heap_picture.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "heap_file.h"
#include "io/exr.h"

namespace mesograin::referee {
namespace {

const std::filesystem::path heaps = std::filesystem::path(MESOGRAIN_TEST_DATA) / "heaps";

/// Of 12 x 12 blocks.
std::array<double, 144> blocks(int width, const auto& radiance) {
  std::array<double, 144> sums{};
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(width);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    const std::size_t x = pixel % static_cast<std::size_t>(width) * 12 / static_cast<std::size_t>(width);
    const std::size_t y = pixel / static_cast<std::size_t>(width) * 12 / static_cast<std::size_t>(width);
    sums[12 * y + x] += radiance(pixel) / static_cast<double>(pixels);
  }
  return sums;
}

// Of 16 paths a pixel: their noise in blocks is about 2 %.
TEST(HeapPicture, IsThatOfAnotherPathTracer) {
  std::ifstream file(heaps / "manifest.json");
  const nlohmann::json manifest = nlohmann::json::parse(file);
  for (const nlohmann::json& image : manifest.at("images")) {
    nlohmann::json setup{{"spheres", (heaps / "spheres.csv").string()},
                         {"camera", manifest.at("camera")},
                         {"resolution", manifest.at("resolution")},
                         {"material", image.at("material")},
                         {"light", image.at("light")}};
    const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "heap_picture_test.json";
    std::ofstream(path) << setup;
    std::vector<HeapCase> cases = heap_cases(path);
    ASSERT_EQ(cases.size(), 1U);
    cases[0].samples = 16;
    const HeapPicture picture = trace_heap(cases[0]);
    const auto found = blocks(96, [&](std::size_t pixel) { return picture.radiance[pixel].all; });
    const io::ExrFile truth = io::read_exr(heaps / image.at("file").get<std::string>());
    const auto stride = static_cast<std::size_t>(truth.image.channels);
    const auto right = blocks(96, [&](std::size_t pixel) { return truth.image.pixels[pixel * stride + stride / 3]; });
    double sum = 0;
    double all = 0;
    double apart = 0;
    for (std::size_t block = 0; block < right.size(); ++block) {
      sum += found[block];
      all += right[block];
      apart += std::abs(found[block] - right[block]);
    }
    EXPECT_NEAR(sum, all, 0.012 * all) << image.at("file");
    EXPECT_LT(apart, 0.04 * all) << image.at("file");
  }
}

// Of two balls in a row, lit from aside, the second is seen through the first as far as light goes straight through.
TEST(HeapPicture, ShowsWhatIsBehind) {
  HeapCase setup;
  setup.balls = {{{0, 0, 5}, 1}};
  setup.material = {.sigma_s = 0.5, .sigma_a = 0.5};
  setup.light.direction = {1, 0, 0};
  setup.camera = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 0.01, 0.01};
  setup.width = setup.height = 8;
  setup.samples = 4096;
  const auto mean_of = [&](double HeapRadiance::*part) {
    double sum = 0;
    for (const HeapRadiance& of : trace_heap(setup).radiance) sum += of.*part / 64;
    return sum;
  };
  const double alone = mean_of(&HeapRadiance::direct);
  EXPECT_EQ(mean_of(&HeapRadiance::behind), 0);
  setup.balls.push_back({{0, 0, 0}, 1});
  EXPECT_NEAR(mean_of(&HeapRadiance::direct), alone, 0.01 * alone);
  EXPECT_NEAR(mean_of(&HeapRadiance::behind), std::exp(-2.0) * alone, 0.02 * std::exp(-2.0) * alone);
}

// A white grain in white light is invisible, whatever its surface is.
TEST(HeapPicture, LosesNoLight) {
  HeapCase setup;
  setup.balls = {{{0, 0, 0}, 1}, {{2, 0, 0}, 1}, {{1, 1.7320508, 0}, 1}};
  setup.camera = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 0.4, 0.4};
  setup.light.sky = true;
  setup.width = setup.height = 8;
  setup.samples = 256;
  for (const HeapMaterial& material : {HeapMaterial{.diffuse = true, .reflectance = 1}, HeapMaterial{.sigma_s = 3},
                                       HeapMaterial{.sigma_s = 3, .eta = 1.5}}) {
    setup.material = material;
    double sum = 0;
    for (const double sign : {1.0, -1.0}) {
      // Both halves of the sky are all of it.
      setup.camera.direction.z = sign;
      for (const HeapRadiance& of : trace_heap(setup).radiance) sum += of.all / 64;
    }
    EXPECT_NEAR(sum, 1.0, 0.02) << material.eta;
  }
}

}  // namespace
}  // namespace mesograin::referee

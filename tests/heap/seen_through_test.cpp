// What shows through a grain where none answers another.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "heap/gather.h"
#include "heaps.h"

namespace mesograin::heap {
namespace {

const glm::vec3 up(0.0F, 0.0F, 1.0F);

// From above, through the first ball onto the second.
float behind(Heap heap) {
  heap.exchanges = false;
  heap.lights.emplace_back(scene::DirectionalLight{{0.8, 0.0, 0.6}, glm::dvec3(3.0)});
  const Gather gather(heap, std::make_shared<const HeapLight>(light_alone(heap, {})));
  transport::Random random(1, 0);
  constexpr int looks = 1 << 15;
  double sum = 0.0;
  for (int i = 0; i < looks; ++i) sum += gather.lit_behind(0, up, up, random).r / looks;
  return static_cast<float>(sum);
}

Heap row(const Optics& second) {
  Heap heap;
  heap.grains.kinds = {medium(0.5, 0.9), second};
  heap.grains.grains = {{glm::vec3(0.0F), 1.0F, 0}, {-4.0F * up, 1.0F, 1}};
  return heap;
}

TEST(SeenThrough, IsAWhiteBallInItsOwnLight) {
  const double right = std::exp(-1.0) * 0.5 * 3.0 * 0.6 / std::numbers::pi;
  EXPECT_NEAR(behind(row(lambert(0.5))), right, 0.02 * right);
}

// Light that is scattered once, in a ball that hardly scatters: int sigma_s e^(-sigma s) phase E e^(-sigma chord) ds.
TEST(SeenThrough, IsABallWhoseLightComesFromWithin) {
  constexpr double sigma_t = 2.0;
  constexpr double albedo = 1e-3;
  double right = 0.0;
  constexpr int steps = 4096;
  for (int step = 0; step < steps; ++step) {
    const double depth = 2.0 * (step + 0.5) / steps;
    const double height = 1.0 - depth;
    const double along = 0.6 * height;
    const double chord = -along + std::sqrt(along * along + 1.0 - height * height);
    right += 2.0 / steps * sigma_t * albedo * std::exp(-sigma_t * (depth + chord)) * 3.0 / (4.0 * std::numbers::pi);
  }
  right *= std::exp(-1.0);
  EXPECT_NEAR(behind(row(medium(sigma_t, albedo))), right, 0.02 * right);
}

TEST(SeenThrough, IsNothingWhereNothingIs) {
  Heap heap = row(lambert(0.5));
  heap.grains.grains.pop_back();
  EXPECT_EQ(behind(heap), 0.0F);
}

}  // namespace
}  // namespace mesograin::heap

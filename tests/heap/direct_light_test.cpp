// How much few rays to a light tell of what it does to a grain.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <vector>

#include "heap/exchange.h"
#include "heaps.h"
#include "scene/world.h"

namespace mesograin::heap {
namespace {

/// Brighter above, and a sun in it that is a quarter of all light.
scene::World sky_with_a_sun() {
  constexpr int height = 32;
  std::vector<glm::vec3> texels(2 * height * height, glm::vec3(0.1F));
  std::fill_n(texels.begin(), texels.size() / 2, glm::vec3(0.5F));
  texels[8 * 2 * height + 11] = glm::vec3(300.0F);
  scene::World world;
  world.radiance = glm::dvec3(1.0);
  world.image = std::make_shared<const scene::Surroundings>(2 * height, height, std::move(texels));
  return world;
}

SharedField sent_by_balls(int light_rays) {
  Heap heap = lattice(6, medium(5.0, 0.9), 1e4);
  heap.world = sky_with_a_sun();
  Quality quality;
  quality.light_rays = light_rays;
  return solve_exchange(heap, quality, {}, {}).sent;
}

// Rays that all come in the more aslant the further around their direction lies are four times as far off.
TEST(DirectLight, PlacesOnALightHaveNothingToDoWithThoseOnTheGrain) {
  const SharedField few = sent_by_balls(64);
  const glm::vec4 right = sent_by_balls(8192)[0].channels[1];
  double square = 0.0;
  for (const Coefficients& of : few) {
    const glm::vec4 off = of.channels[1] - right;
    square += static_cast<double>(glm::dot(off, off)) / static_cast<double>(few.size());
  }
  EXPECT_LT(std::sqrt(square), 0.3 * right.w);
}

}  // namespace
}  // namespace mesograin::heap

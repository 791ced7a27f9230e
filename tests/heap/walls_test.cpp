// Grounds and walls against what must hold of them: they keep a furnace even, stop the world's light, and are known
// wherever their surface is.
#include "heap/walls.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <numbers>

#include "heap/exchange.h"
#include "heap/gather.h"
#include "heaps.h"

namespace mesograin::heap {
namespace {

scene::MeshPointer square(float half) {
  return std::make_shared<const scene::Mesh>(
      std::vector<glm::vec3>{{-half, -half, 0.0F}, {half, -half, 0.0F}, {half, half, 0.0F}, {-half, half, 0.0F}},
      std::vector<glm::vec3>{}, std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}});
}

/// A bowl: the lower half of a sphere of radius 1, as an open surface.
scene::MeshPointer bowl() {
  constexpr unsigned rings = 24;
  constexpr unsigned sectors = 48;
  std::vector<glm::vec3> positions;
  for (unsigned ring = 0; ring <= rings; ++ring)
    for (unsigned sector = 0; sector < sectors; ++sector) {
      const double polar = 0.5 * std::numbers::pi * (1.0 + static_cast<double>(ring) / rings);
      const double azimuth = 2.0 * std::numbers::pi * sector / sectors;
      positions.emplace_back(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar));
    }
  std::vector<glm::uvec3> triangles;
  for (unsigned ring = 0; ring < rings; ++ring)
    for (unsigned sector = 0; sector < sectors; ++sector) {
      const unsigned a = ring * sectors + sector;
      const unsigned b = ring * sectors + (sector + 1) % sectors;
      triangles.emplace_back(a, b, a + sectors);
      triangles.emplace_back(b, b + sectors, a + sectors);
    }
  return std::make_shared<const scene::Mesh>(std::move(positions), std::vector<glm::vec3>{}, std::move(triangles));
}

/// A few grains on a wide ground.
Heap on_ground(const Optics& grains, const Optics& ground) {
  Heap heap;
  heap.grains.kinds = {grains, ground};
  for (int x = 0; x < 3; ++x)
    for (int y = 0; y < 3; ++y)
      for (int z = 0; z < 2; ++z) heap.grains.grains.push_back({glm::vec3(2.1 * x, 2.1 * y, 1.0 + 2.1 * z), 1.0F, 0});
  heap.grains.walls.push_back({square(4000.0F), glm::dmat4(1.0), 1});
  return heap;
}

TEST(Walls, KeepAWhiteFurnaceEven) {
  Heap heap = on_ground(lambert(1.0), lambert(1.0));
  heap.world.radiance = glm::dvec3(1.0);
  const HeapLight light = solve_exchange(heap, {}, {}, {});
  ASSERT_GT(light.sent.size(), heap.grains.grains.size());
  double sum = 0.0;
  for (const Coefficients& sent : light.sent) {
    EXPECT_NEAR(sent.channels[0].w, 1.0F, 0.04F);
    sum += static_cast<double>(sent.channels[0].w) / static_cast<double>(light.sent.size());
  }
  EXPECT_NEAR(sum, 1.0, 0.01);
}

TEST(Walls, StopTheLightOfTheWorld) {
  Heap heap = on_ground(lambert(0.5), lambert(0.0));
  heap.grains.grains.resize(1);
  heap.world.radiance = glm::dvec3(1.0);
  Quality quality;
  quality.rays = 1 << 14;
  const HeapLight light = solve_exchange(heap, quality, {}, {});
  // A sphere on black ground sees the sky with (1 + n . up) / 2 of each normal's cosine-weighted hemisphere.
  EXPECT_NEAR(light.sent[0].channels[0].w, 0.25F, 0.01F);
  EXPECT_NEAR(light.sent[0].channels[0].z, 0.25F, 0.02F);
}

// Light of a sun at the zenith comes back from a wide ground as from an even world below, but for the grain's shadow
// and what the grain itself sends down.
// The ball that stands for a grain dips into the ground that the grain lies on: light that would leave it below is the
// ground's.
TEST(Walls, HaveNoLightBehindThem) {
  Heap heap;
  heap.grains.kinds = {medium(1.0, 0.999), lambert(0.0)};
  heap.grains.grains = {{glm::vec3(0.0F, 0.0F, 0.6F), 1.0F, 0}};
  heap.grains.walls.push_back({square(100.0F), glm::dmat4(1.0), 1});
  heap.world.radiance = glm::dvec3(1.0);
  const auto light = std::make_shared<const HeapLight>(solve_exchange(heap, Quality{}, {}, {}));
  const Space space(heap.grains, light->kinds);
  const glm::vec3 down = glm::normalize(glm::vec3(0.2F, 0.1F, -1.0F));
  EXPECT_GT(space.place(heap.grains.grains[0], down).z, 0.0F);
  EXPECT_LT(space.place(heap.grains.grains[0], down).z, 1e-3F);
  EXPECT_NEAR(space.place(heap.grains.grains[0], -down).z, 0.6F - down.z, 1e-3F);
  // Straight through it from above there is the black ground.
  transport::Random random(4, 0);
  const glm::vec3 up(0.0F, 0.0F, 1.0F);
  const Gather::All seen = Gather(heap, light).look_at_all(0, up, up, up, {4096}, random);
  EXPECT_EQ(seen.world, glm::vec3(0.0F));
  // Of what is scattered half goes down.
  EXPECT_LT(seen.scattered.r + seen.others.r, 0.6F);
  EXPECT_GT(seen.scattered.r, 0.1F);
}

TEST(Walls, LightAGrainHighAboveFromBelow) {
  Heap heap = on_ground(lambert(0.5), lambert(0.6));
  heap.grains.grains = {{glm::vec3(0.0F, 0.0F, 40.0F), 1.0F, 0}};
  heap.lights.emplace_back(scene::DirectionalLight{{0.0, 0.0, 1.0}, glm::dvec3(std::numbers::pi)});
  Quality quality;
  quality.rays = 1 << 16;
  const HeapLight light = solve_exchange(heap, quality, {}, {});
  EXPECT_NEAR(light.answer[0].channels[0].w, 0.5F * 0.6F * 0.5F, 0.004F);
  EXPECT_NEAR(light.answer[0].channels[0].z, -0.5F * 0.6F * 0.5F, 0.008F);
}

// Inside a half sphere of reflectance .8 half of what is seen is sky and half the bowl: it sends .8 (1 / 2 + 1 / 2 of
// what it sends), of which .4 of the sky's; what faces outwards sees no part of it.
TEST(Walls, OfAHollowGrainAloneSendEachOtherLight) {
  Heap heap;
  heap.grains.kinds = {lambert(0.8)};
  heap.grains.walls.push_back({bowl(), glm::dmat4(1.0), 0});
  heap.world.radiance = glm::dvec3(1.0);
  EXPECT_TRUE(solve_exchange(heap, {}, {}, {}).answer.empty());
  heap.grains.walls[0].hollow = true;
  const HeapLight light = solve_exchange(heap, {}, {}, {});
  ASSERT_GT(light.answer.size(), 500U);
  const auto near = [&](float expected) {
    return std::count_if(light.answer.begin(), light.answer.end(),
                         [&](const Coefficients& answer) { return std::abs(answer.channels[0].w - expected) < 0.05F; });
  };
  const auto third = static_cast<std::ptrdiff_t>(light.answer.size() / 3);
  EXPECT_GT(near(0.0F), third);
  EXPECT_GT(near(0.4F / 0.6F - 0.4F), third);
  EXPECT_GT(near(0.0F) + near(0.4F / 0.6F - 0.4F), 5 * third / 2);
}

TEST(Walls, AreKnownWhereverTheirSurfaceIs) {
  Grains grains;
  grains.kinds = {lambert(0.5)};
  for (int i = 0; i < 20; ++i) grains.grains.push_back({glm::vec3(0.3 * i, 0.1 * i, 0.0), 0.2F, 0});
  glm::dmat4 tilted(1.0);
  tilted[0] = {0.7, 0.1, 0.7, 0.0};
  tilted[1] = {0.0, 1.0, -0.2, 0.0};
  glm::dmat4 mirrored(1.0);
  mirrored[0][0] = -7.0;
  mirrored[1][1] = mirrored[2][2] = 7.0;
  grains.walls = {{square(300.0F), tilted, 0}, {bowl(), mirrored, 0}, {bowl(), glm::dmat4(1.0), 0}};
  for (const std::size_t most : {500UL, 5000UL, 50000UL}) {
    const Patches patches(grains, most);
    transport::Random random(1, 0);
    for (std::uint32_t number = 0; number < grains.walls.size(); ++number) {
      const Wall& wall = grains.walls[number];
      const std::vector<glm::vec3> positions = places_of(*wall.mesh, wall.to_heap);
      for (const glm::uvec3& triangle : wall.mesh->triangles())
        for (int i = 0; i < 2000 / static_cast<int>(wall.mesh->triangles().size()) + 4; ++i) {
          const float along = std::sqrt(random.uniform());
          const float across = random.uniform() * along;
          const glm::vec3 place = positions[triangle.x] + along * (positions[triangle.y] - positions[triangle.x]) +
                                  across * (positions[triangle.z] - positions[triangle.y]);
          const glm::vec3 normal = glm::normalize(
              glm::cross(positions[triangle.y] - positions[triangle.x], positions[triangle.z] - positions[triangle.x]));
          for (const float side : {1.0F, -1.0F}) {
            const std::optional<std::uint32_t> node = patches.draw(number, place, side * normal, random);
            ASSERT_TRUE(node) << number << " at " << place.x << " " << place.y << " " << place.z;
            EXPECT_EQ(patches.nodes()[*node].wall, number);
          }
        }
    }
  }
}

TEST(Walls, AreFewPatchesHoweverLarge) {
  Heap heap = on_ground(lambert(0.5), lambert(0.5));
  heap.grains.walls[0].to_heap = glm::dmat4(1e4);
  EXPECT_LT(Patches(heap.grains, 100000).nodes().size(), 20000U);
}

TEST(Walls, ThatAreFlatOrFoldedOrCutGrainsAreFinite) {
  Heap heap = on_ground(lambert(1.0), lambert(1.0));
  heap.grains.walls.push_back({square(1.0F), glm::dmat4(0.0), 1});
  heap.grains.walls.push_back({bowl(), glm::dmat4(1.0), 1});
  heap.grains.walls.push_back({bowl(), glm::dmat4(1.0), 1});
  heap.lights.emplace_back(scene::PointLight{{0.0, 0.0, 0.0}, glm::dvec3(1.0)});
  heap.world.radiance = glm::dvec3(0.3);
  const HeapLight light = solve_exchange(heap, {}, {}, {});
  for (const Coefficients& numbers : light.sent)
    for (const glm::vec4& channel : numbers.channels)
      for (int i = 0; i < 4; ++i) ASSERT_TRUE(std::isfinite(channel[i]));
}

}  // namespace
}  // namespace mesograin::heap

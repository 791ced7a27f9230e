// A heap on a ground that has gone elsewhere is seen as it was, by the light of where it was.
#include "heap/moved_light.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "heap/gather.h"
#include "heaps.h"

namespace mesograin::heap {
namespace {

scene::MeshPointer square(float half) {
  const std::vector<glm::vec3> positions = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
  return std::make_shared<const scene::Mesh>(positions, std::vector<glm::vec3>(4, {0, 0, 1}),
                                             std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}});
}

Heap on_a_ground() {
  Heap heap;
  Optics red = lambert(0.6);
  red.reflectance = glm::dvec3(0.6, 0.2, 0.1);
  heap.grains.kinds = {lambert(0.8), red};
  for (int x = 0; x < 4; ++x)
    for (int y = 0; y < 4; ++y) heap.grains.grains.push_back({{2.1F * x, 2.1F * y, 1.05F}, 1.0F, 0});
  heap.grains.walls.push_back({square(40.0F), glm::dmat4(1.0), 1});
  heap.lights.emplace_back(scene::DirectionalLight{{0.0, 0.6, 0.8}, glm::dvec3(3.0)});
  heap.world.radiance = glm::dvec3(0.5);
  return heap;
}

HeapLight solved(const Heap& heap) {
  Quality quality;
  quality.rays = 1 << 10;
  return solve_exchange(heap, quality, {}, {});
}

Heap moved(Heap heap, const glm::dmat4& by) {
  for (Grain& grain : heap.grains.grains) grain.middle = glm::vec3(by * glm::dvec4(grain.middle, 1.0));
  for (Wall& wall : heap.grains.walls) wall.to_heap = by * wall.to_heap;
  return heap;
}

/// What is seen of all grains and the ground between them from above, each from one side.
glm::vec3 seen(const Heap& heap, const HeapLight& light) {
  const Gather gather(heap, std::make_shared<const HeapLight>(light));
  transport::Random random(3, 0);
  glm::vec3 sum(0.0F);
  for (std::uint32_t grain = 0; grain < heap.grains.grains.size(); ++grain)
    for (const glm::vec3& normal : {glm::vec3(0, 0, 1), glm::vec3(0.6, 0, 0.8), glm::vec3(0, 0.8, -0.6)})
      sum += gather.look(grain, normal, glm::normalize(normal + glm::vec3(0.1, 0.2, 0.3)), 256, random);
  return sum;
}

TEST(MovedLight, ShowsAHeapThatHasGoneElsewhereAsItWas) {
  const Heap before = on_a_ground();
  const HeapLight light = solved(before);
  const Heap now = moved(before, glm::translate(glm::dmat4(1.0), glm::dvec3(1.0, 0.4, 0.7)));
  const std::optional<HeapLight> carried = moved_light(light, before.grains, now.grains);
  ASSERT_TRUE(carried.has_value());
  const glm::vec3 expected = seen(before, light);
  const glm::vec3 found = seen(now, *carried);
  for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(found[channel] / expected[channel], 1.0F, 0.01F);
}

TEST(MovedLight, KeepsItsTreeWhereNothingWasMoved) {
  const Heap heap = on_a_ground();
  const HeapLight light = solved(heap);
  EXPECT_EQ(moved_light(light, heap.grains, heap.grains)->neighbourhood, light.neighbourhood);
  const Heap now = moved(heap, glm::translate(glm::dmat4(1.0), glm::dvec3(1.0, 0.4, 0.7)));
  EXPECT_FALSE(moved_light(light, heap.grains, now.grains)->neighbourhood);
}

TEST(MovedLight, HasAWallsLightWhereItsPlacesAreNow) {
  const Heap before = on_a_ground();
  const HeapLight light = solved(before);
  const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), 0.5, glm::dvec3(0, 0, 1));
  const Heap now = moved(before, turn);
  const std::optional<HeapLight> carried = moved_light(light, before.grains, now.grains);
  ASSERT_TRUE(carried.has_value());
  ASSERT_EQ(carried->answer.size(), carried->seats->told() + carried->patches.nodes().size());
  transport::Random random(5, 0);
  const auto sent_at = [&](const HeapLight& of, const glm::vec3& place) {
    float sum = 0.0F;
    constexpr int draws = 64;
    for (int i = 0; i < draws; ++i) {
      const std::optional<std::uint32_t> node = of.patches.draw(0, place, {0, 0, 1}, random);
      if (node) sum += of.answer[of.seats->told() + *node].channels[0].w / draws;
    }
    return sum;
  };
  double least = 1e9;
  double most = 0.0;
  for (const glm::vec3& place :
       {glm::vec3(1.05, 1.05, 0), glm::vec3(-3, 2, 0), glm::vec3(3.15, 5.25, 0), glm::vec3(9, 9, 0)}) {
    const float was = sent_at(light, place);
    const float is = sent_at(*carried, glm::vec3(turn * glm::dvec4(place, 1.0)));
    EXPECT_NEAR(is, was, 0.1F * was + 0.01F);
    least = std::min<double>(least, was);
    most = std::max<double>(most, was);
  }
  EXPECT_GT(most, 1.5 * least) << "all places are alike";
}

TEST(MovedLight, KeepsTheGridsOfWallsThatStay) {
  const Heap before = on_a_ground();
  const HeapLight light = solved(before);
  Heap now = before;
  now.grains.grains[5].middle.z += 1.0F;
  const std::optional<HeapLight> carried = moved_light(light, before.grains, now.grains);
  ASSERT_TRUE(carried.has_value());
  EXPECT_TRUE(carried->patches == light.patches);
  EXPECT_EQ(carried->sent.size(), light.sent.size());
}

TEST(MovedLight, IsNoneOfOtherGrains) {
  const Heap before = on_a_ground();
  const HeapLight light = solved(before);
  Heap fewer = before;
  fewer.grains.grains.pop_back();
  EXPECT_FALSE(moved_light(light, before.grains, fewer.grains).has_value());
  Heap others = before;
  others.grains.grains[3].kind = 1;
  EXPECT_FALSE(moved_light(light, before.grains, others.grains).has_value());
  Heap open = before;
  open.grains.walls.clear();
  EXPECT_FALSE(moved_light(light, before.grains, open.grains).has_value());
}

}  // namespace
}  // namespace mesograin::heap

// What a heap's light is taken to be when its materials change against what it is.
#include "heap/changed_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "heaps.h"

namespace mesograin::heap {
namespace {

Heap heap_of(const Optics& optics) {
  Heap heap = lattice(6, optics);
  heap.lights.emplace_back(scene::DirectionalLight{{0.0, 0.6, 0.8}, glm::dvec3(3.0)});
  heap.world.radiance = glm::dvec3(0.3);
  return heap;
}

HeapLight light_of(const Heap& heap) {
  Quality quality;
  quality.rays = 512;
  return solve_exchange(heap, quality, {}, {});
}

/// Of the means of each grain, summed up: how far one is from the other.
float apart(const Field& one, const Field& other) {
  float off = 0.0F;
  float all = 0.0F;
  for (std::size_t i = 0; i < other.size(); ++i) {
    off += std::abs(one[i].channels[1].w - other[i].channels[1].w);
    all += other[i].channels[1].w;
  }
  return off / all;
}

TEST(ChangedLight, IsMostOfTheWayToWhatItIs) {
  for (const auto& [from, to] : {std::tuple{medium(3.0, 0.9), medium(3.0, 0.92)},
                                 {medium(3.0, 0.9), medium(3.0, 0.97)},
                                 {medium(3.0, 0.97), medium(3.0, 0.9)},
                                 {medium(3.0, 0.99), medium(3.0, 0.999)},
                                 {medium(1.0, 0.99), medium(2.0, 0.99)},
                                 {lambert(0.5), lambert(0.8)}}) {
    const Heap before = heap_of(from);
    const Heap now = heap_of(to);
    const HeapLight was = light_of(before);
    const HeapLight is = light_of(now);
    HeapLight taken = was;
    change(taken, before.grains, now.grains);
    EXPECT_LT(apart(taken.sent, is.sent), 0.45F * apart(was.sent, is.sent)) << from.albedo.g << " " << to.albedo.g;
    EXPECT_LT(apart(taken.answer, is.answer), 0.55F * apart(was.answer, is.answer))
        << from.albedo.g << " " << to.albedo.g;
  }
}

TEST(ChangedLight, ChangesOnlyTheGrainsThatDoAndWhatOthersMakeOfThem) {
  Heap before = heap_of(lambert(0.5));
  before.grains.kinds.push_back(lambert(0.5));
  before.grains.kinds.back().eta = 1.1;  // another kind, whatever that says
  for (std::size_t i = 0; i < before.grains.grains.size(); i += 2) before.grains.grains[i].kind = 1;
  Heap now = before;
  now.grains.kinds[1].reflectance = glm::dvec3(0.25, 0.5, 0.5);
  const HeapLight was = light_of(before);
  HeapLight taken = was;
  change(taken, before.grains, now.grains);
  const auto red = [](const HeapLight& light, std::size_t i) { return light.sent[i].channels[0].w; };
  for (std::size_t i = 0; i < before.grains.grains.size(); ++i) {
    EXPECT_EQ(taken.sent[i].channels[1], was.sent[i].channels[1]) << i;
    EXPECT_LT(red(taken, i), (i % 2 == 0 ? 0.51F : 1.0F) * red(was, i)) << i;
    EXPECT_GT(red(taken, i), (i % 2 == 0 ? 0.35F : 0.7F) * red(was, i)) << i;
  }
}

}  // namespace
}  // namespace mesograin::heap

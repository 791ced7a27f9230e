// Grains that are Lambert surfaces to each other, and what they are where they are seen: as among others that are
// Lambert everywhere.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/vec3.hpp>
#include <memory>

#include "heap/gather.h"
#include "heap/spread.h"
#include "heaps.h"

namespace mesograin::heap {
namespace {

constexpr double veil = 0.25;
constexpr std::size_t in_the_middle = 13;

Optics walked(Surface surface) {
  Optics optics = medium(3.0, 0.97);
  optics.surface = surface;
  optics.eta = surface == Surface::lambert_refracted ? 1.4 : 1.0;
  return optics;
}

Optics veiled(Surface surface) {
  Optics optics = walked(surface);
  optics.reflectance = glm::dvec3(veil);
  return optics;
}

Heap lit(const Optics& optics) {
  Heap heap = lattice(3, optics, 6.0);
  heap.lights.emplace_back(scene::DirectionalLight{{0.0, 0.6, 0.8}, glm::dvec3(3.0)});
  heap.world.radiance = glm::dvec3(0.3);
  return heap;
}

/// One that is walked in everywhere, among Lambert ones. What it sends differs, but little of that comes back.
Heap one_among_lambert(Surface surface) {
  Heap heap = lit(lambert(veil));
  heap.grains.kinds.push_back(walked(surface));
  heap.grains.grains[in_the_middle].kind = 1;
  return heap;
}

std::shared_ptr<const HeapLight> solved(const Heap& heap, int rays = 1 << 15) {
  Quality quality;
  quality.rays = quality.light_rays = rays;
  return std::make_shared<const HeapLight>(solve_exchange(heap, quality, {}, {}));
}

TEST(Veil, SendsWhatALambertSurfaceSends) {
  const Heap heap = lit(veiled(Surface::lambert_lambert));
  const std::shared_ptr<const HeapLight> found = solved(heap, 256);
  const std::shared_ptr<const HeapLight> right = solved(lit(lambert(veil)), 256);
  ASSERT_EQ(found->sent.size(), right->sent.size());
  for (std::size_t i = 0; i < right->sent.size(); ++i)
    EXPECT_EQ(found->sent[i].channels[1], right->sent[i].channels[1]) << i;
}

TEST(Veil, AnswersAsWhatIsSeenOfIt) {
  for (const Surface surface : {Surface::lambert_lambert, Surface::lambert_refracted}) {
    const std::shared_ptr<const HeapLight> found = solved(lit(veiled(surface)));
    const std::shared_ptr<const HeapLight> right = solved(one_among_lambert(surface));
    const glm::vec4 answer = found->answer[in_the_middle].channels[1];
    const glm::vec4 expected = right->answer[in_the_middle].channels[1];
    EXPECT_NEAR(answer.w, expected.w, 0.03F * expected.w);
    // As far as tables of other random numbers agree: across the sun, where it is 0, they find .05.
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(answer[axis], expected[axis], 0.1F * expected.w) << axis;
    // A test that compares like with like: of a Lambert surface it would be less than half.
    const std::shared_ptr<const HeapLight> surface_alone = solved(lit(lambert(veil)));
    EXPECT_LT(surface_alone->answer[in_the_middle].channels[1].w, 0.6F * expected.w);
  }
}

TEST(Veil, IsGatheredAsWhatIsSeenOfIt) {
  const auto looked_at = [](const Heap& heap, auto look) {
    const Gather gather(heap, solved(heap));
    transport::Random random(3, 0);
    const Spread spread(random);
    double sum = 0.0;
    constexpr int looks = 1 << 14;
    for (int i = 0; i < looks; ++i) {
      const std::array<float, 5> point = spread.point(i);
      const glm::vec3 normal = transport::isotropic(point[0], point[1]);
      const glm::vec3 towards =
          TurnedFrame(normal, point[3]) * glm::vec3(std::sqrt(1.0F - point[2]), 0.0F, std::sqrt(point[2]));
      sum += look(gather, normal, towards, random) / looks;
    }
    return sum;
  };
  const auto by_table = [](const Gather& gather, const glm::vec3& normal, const glm::vec3& towards, auto& random) {
    return static_cast<double>(gather.look(in_the_middle, normal, towards, 1, random).r);
  };
  const auto by_walks = [](const Gather& gather, const glm::vec3& normal, const glm::vec3& towards, auto& random) {
    const Gather::Walks walks{1, 1};
    return static_cast<double>(gather.look_at_all(in_the_middle, normal, normal, towards, walks, random).others.r);
  };
  const Heap heap = lit(veiled(Surface::lambert_lambert));
  const Heap among = one_among_lambert(Surface::lambert_lambert);
  for (const double found : {looked_at(heap, by_table), looked_at(heap, by_walks)}) {
    const double expected = looked_at(among, by_walks);
    EXPECT_NEAR(found, expected, 0.03 * expected);
  }
}

}  // namespace
}  // namespace mesograin::heap

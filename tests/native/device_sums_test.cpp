// What the device sums of light between grains is what the processor does, and where it cannot, the processor does.
#include "render/device_sums.h"

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <utility>
#include <vector>

#include "expect_error.h"
#include "gl/context_thread.h"
#include "heap/solver.h"
#include "heaps.h"

namespace mesograin::render {
namespace {

using heap::Coefficients;
using heap::Field;
using heap::HeapLight;
using heap::Quality;
using test::expect_error;

/// Of all numbers, relative.
double apart(const Field& found, const Field& right) {
  EXPECT_EQ(found.size(), right.size());
  glm::dvec3 squares(0.0);
  glm::dvec3 size(0.0);
  for (std::size_t i = 0; i < right.size(); ++i) {
    const Coefficients off = found[i] - right[i];
    squares += glm::dvec3(product(off, off));
    size += glm::dvec3(product(right[i], right[i]));
  }
  const double all = size.r + size.g + size.b;
  return all > 0.0 ? std::sqrt((squares.r + squares.g + squares.b) / all) : 0.0;
}

/// What the device was asked for.
struct Asked {
  int sums = 0;
  double farthest = 0.0;  ///< from the processor's sum
  bool fine = false;
  bool shared = false;
  bool changed = false;
  bool walls = false;  ///< nodes of them answer
  bool alone = false;  ///< some meet no other
};

/// Holds each sum of the device against the processor's; calls `after` each.
class Compared : public heap::Sums {
 public:
  Compared(std::unique_ptr<heap::Sums> sums, const heap::Links& links, const heap::Change* change, Asked& asked,
           std::function<void(int sums)> after)
      : sums_(std::move(sums)), links_(links), change_(change), asked_(asked), after_(std::move(after)) {
    asked.fine = !links.fine.empty();
    asked.shared = links.seats->shared();
    asked.changed = change != nullptr;
    asked.walls = links.of.size() > links.seats->answering();
    asked.alone = std::any_of(links.of.begin(), links.of.end(), std::mem_fn(&std::vector<heap::Link>::empty));
  }

  void gather(const Field& sent, Field& answer, const transport::Effort& effort) override {
    sums_->gather(sent, answer, effort);
    Field right;
    links_.gather(sent, right, {}, change_);
    asked_.farthest = std::max(asked_.farthest, apart(links_.seats->told(answer), right));
    ++asked_.sums;
    if (after_) after_(asked_.sums);
  }

 private:
  std::unique_ptr<heap::Sums> sums_;
  const heap::Links& links_;
  const heap::Change* change_;
  Asked& asked_;
  std::function<void(int sums)> after_;
};

heap::MakeSums compared(Asked& asked, const std::function<void(int sums)>& after = {}) {
  return [&asked, after](const heap::Links& links, const heap::Change* change,
                         const transport::Effort& effort) -> std::unique_ptr<heap::Sums> {
    std::unique_ptr<heap::Sums> sums = make_sums(Summing::device)(links, change, effort);
    if (!sums) return nullptr;
    return std::make_unique<Compared>(std::move(sums), links, change, asked, after);
  };
}

/// Of tints that differ, so that no channel is taken for another.
heap::Heap lit(heap::Heap heap) {
  heap.lights.emplace_back(scene::DirectionalLight{{0.0, 0.6, 0.8}, glm::dvec3(3.0, 2.0, 1.0)});
  heap.world.radiance = glm::dvec3(0.3, 0.1, 0.5);
  return heap;
}

Quality exact(Quality quality = {}) {
  quality.tolerance = 1e-5F;
  return quality;
}

heap::Optics glass() {
  heap::Optics optics = heap::medium(0.4, 1.0);
  optics.surface = heap::Surface::dielectric;
  optics.eta = 1.5;
  return optics;
}

class DeviceSumsTest : public testing::Test {
 protected:
  void SetUp() override { gl::ContextThread::instance(); }

  /// Solves it by both.
  static Asked expect_alike(const heap::Heap& heap, const Quality& quality) {
    Asked asked;
    const HeapLight found = heap::Solver().solve(heap, quality, {}, compared(asked));
    const HeapLight right = heap::Solver().solve(heap, quality, {});
    expect_alike(found, right, asked);
    return asked;
  }

  static void expect_alike(const HeapLight& found, const HeapLight& right, const Asked& asked) {
    EXPECT_TRUE(found.summed_on_device);
    EXPECT_FALSE(right.summed_on_device);
    EXPECT_GT(asked.sums, 2 * found.steps);
    EXPECT_LT(asked.farthest, 2e-6);
    EXPECT_LT(apart(found.sent, right.sent), 1e-4);
    EXPECT_LT(apart(found.answer, right.answer), 1e-4);
    EXPECT_LT(apart(found.scattered, right.scattered), 1e-4);
  }
};

TEST_F(DeviceSumsTest, AreTheProcessorsOfTranslucentGrains) {
  heap::Optics coloured = heap::medium(3.0, 0.9);
  coloured.albedo = {0.99, 0.9, 0.5};
  coloured.sigma_t = {1.0, 3.0, 5.0};
  EXPECT_FALSE(expect_alike(lit(heap::lattice(6, coloured)), exact()).fine);
}

TEST_F(DeviceSumsTest, AreTheProcessorsToOrder2) {
  EXPECT_TRUE(expect_alike(lit(heap::lattice(6, heap::lambert(0.8))), exact()).fine);
}

TEST_F(DeviceSumsTest, AreTheProcessorsOfClearGrains) {
  const heap::Heap heap = lit(heap::lattice(5, glass()));
  EXPECT_TRUE(expect_alike(heap, exact()).fine);
  EXPECT_FALSE(heap::Solver().solve(heap, heap::coarse, {}, make_sums(Summing::device)).scattered.empty());
}

TEST_F(DeviceSumsTest, AreTheProcessorsWhereDeepGrainsShareTheirNumbers) {
  Quality quality = exact();
  quality.shared_from = 0;
  quality.rays = quality.light_rays = 64;
  quality.seen_rays = 1;
  for (const heap::Optics& optics : {heap::medium(3.0, 0.9), heap::lambert(0.8)}) {
    const Asked asked = expect_alike(lit(heap::lattice(16, optics)), quality);
    EXPECT_TRUE(asked.shared);
    EXPECT_EQ(asked.fine, optics.opaque());
  }
}

TEST_F(DeviceSumsTest, AreTheProcessorsOfLinksThatWereFoundAtAnotherMaterial) {
  // Every other grain stays what it is.
  const auto heap_with = [](const heap::Optics& changing, const heap::Optics& other) {
    heap::Heap heap = lit(heap::lattice(5, changing));
    heap.grains.kinds.push_back(other);
    for (std::size_t i = 0; i < heap.grains.grains.size(); i += 2) heap.grains.grains[i].kind = 1;
    return heap;
  };
  const heap::Heap translucent = heap_with(heap::medium(3.0, 0.8), heap::medium(2.0, 0.9));
  const heap::Heap thinner = heap_with(heap::medium(2.0, 0.9), heap::medium(2.0, 0.9));
  const heap::Heap bright = heap_with(heap::lambert(0.8), heap::lambert(0.7));
  const heap::Heap brighter = heap_with(heap::lambert(0.9), heap::lambert(0.7));
  for (const auto& [before, after] : {std::pair(translucent, thinner), std::pair(bright, brighter)}) {
    Asked asked;
    heap::Solver found;
    heap::Solver right;
    found.solve(before, exact(), {});
    right.solve(before, exact(), {});
    const HeapLight quick = found.solve(after, exact(heap::coarse), {}, compared(asked));
    expect_alike(quick, right.solve(after, exact(heap::coarse), {}), asked);
    EXPECT_TRUE(asked.changed);
  }
}

TEST_F(DeviceSumsTest, AreTheProcessorsWhereSomeMeetNoOther) {
  heap::Heap heap = lit(heap::lattice(3, heap::lambert(0.7)));
  for (const float away : {-1e3F, 1e3F})
    heap.grains.grains.insert(heap.grains.grains.begin() + 5, {{0.0F, 0.0F, away}, 0.1F, 0});
  EXPECT_TRUE(expect_alike(heap, exact()).alone);
}

TEST_F(DeviceSumsTest, AreTheProcessorsWhereWallsAnswerToo) {
  heap::Heap heap = lit(heap::lattice(3, heap::lambert(0.7)));
  heap.grains.kinds.push_back(heap::lambert(0.5));
  const auto ground = std::make_shared<const scene::Mesh>(
      std::vector<glm::vec3>{{-9.0F, -9.0F, -1.1F}, {9.0F, -9.0F, -1.1F}, {9.0F, 9.0F, -1.1F}, {-9.0F, 9.0F, -1.1F}},
      std::vector<glm::vec3>{}, std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}});
  heap.grains.walls.push_back({ground, glm::dmat4(1.0), 1});
  EXPECT_TRUE(expect_alike(heap, exact()).walls);
}

TEST_F(DeviceSumsTest, AreNoneWhereNoGrainMeetsAnother) {
  for (const std::size_t grains : {0U, 1U}) {
    heap::Heap heap = lit(heap::lattice(1, heap::lambert(0.7)));
    heap.grains.grains.resize(grains);
    Asked asked;
    const HeapLight light = heap::Solver().solve(heap, {}, {}, compared(asked));
    EXPECT_EQ(light.sent.size(), grains);
    EXPECT_FALSE(light.summed_on_device);
    EXPECT_EQ(asked.sums, 0);
  }
}

TEST_F(DeviceSumsTest, AreTheSameEachTime) {
  const heap::Heap heap = lit(heap::lattice(5, heap::lambert(0.8)));
  const auto sent = [&] { return heap::Solver().solve(heap, heap::coarse, {}, make_sums(Summing::device)).sent; };
  EXPECT_EQ(apart(sent(), sent()), 0.0);
}

TEST_F(DeviceSumsTest, AreNotTakenOfMoreLinksThanAShaderReads) {
  const auto most = gl::ContextThread::instance().run([] {
    GLint64 bytes = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &bytes);
    return static_cast<std::size_t>(bytes);
  });
  if (most > std::size_t{1} << 28U) GTEST_SKIP() << "It reads all that a heap has.";
  const heap::PackedPlace place(glm::vec3(0.0F));
  heap::Links links;
  links.seats = std::make_shared<const heap::Seats>(1);
  links.of.emplace_back(most / sizeof(heap::Link) + 1, heap::Link{0, place, place, {glm::vec3(0.5F), 0}});
  expect_error([&] { make_sums(Summing::device)(links, nullptr, {}); }, "bytes at most");
}

TEST_F(DeviceSumsTest, AreGivenUpAtOnce) {
  std::atomic<bool> stop = false;
  transport::Effort effort;
  effort.stop = &stop;
  Asked asked;
  heap::Solver solver;
  const heap::Heap heap = lit(heap::lattice(6, heap::medium(3.0, 0.99)));
  EXPECT_THROW(solver.solve(heap, {}, effort, compared(asked, [&](int sums) { stop = sums == 3; })),
               transport::Stopped);
  EXPECT_EQ(asked.sums, 3);
  stop = false;
  const HeapLight right = heap::Solver().solve(heap, exact(), {});
  EXPECT_LT(apart(solver.solve(heap, exact(), effort, make_sums(Summing::device)).sent, right.sent), 1e-4);
}

TEST_F(DeviceSumsTest, AreTheProcessorsOwnOnceTheDeviceIsShutDown) {
  const heap::Heap heap = lit(heap::lattice(5, heap::lambert(0.8)));
  Asked asked;
  const auto shut_down = [](int sums) {
    if (sums == 2) gl::ContextThread::shut_down();
  };
  const HeapLight found = heap::Solver().solve(heap, exact(), {}, compared(asked, shut_down));
  EXPECT_EQ(asked.sums, 2);
  EXPECT_FALSE(found.summed_on_device);
  const HeapLight right = heap::Solver().solve(heap, exact(), {}, make_sums(Summing::device));
  EXPECT_FALSE(right.summed_on_device) << "a context was made that nobody ends";
  EXPECT_LT(apart(found.sent, right.sent), 1e-4);
}

TEST_F(DeviceSumsTest, AreTakenByTheProcessorUnlessThereIsAGpu) {
  EXPECT_FALSE(make_sums(Summing::processor));
  EXPECT_EQ(static_cast<bool>(make_sums(Summing::automatic)), gl::ContextThread::instance().device_info().hardware);
}

}  // namespace
}  // namespace mesograin::render

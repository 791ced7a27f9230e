// What a few moved grains leave as it was is found again to the last bit as from nothing, and nothing else is looked
// at.
#include "heap/moves.h"

#include <gtest/gtest.h>

#include <cstring>

#include "heap/links.h"
#include "heaps.h"

namespace mesograin::heap {
namespace {

const Rays rays{64, 32};
const Rays rays_through{16, 0};
constexpr glm::vec3 radiance(1.0F);

Ways ways_in(const Space& space) {
  Ways ways;
  find_ways(space, rays, rays_through, radiance, ways, {});
  return ways;
}

void expect_same(const Links& found, const Links& right) {
  ASSERT_EQ(found.of.size(), right.of.size());
  for (std::size_t i = 0; i < right.of.size(); ++i) {
    ASSERT_EQ(found.of[i].size(), right.of[i].size()) << i;
    const std::size_t bytes = right.of[i].size() * sizeof(Link);
    EXPECT_TRUE(bytes == 0 || std::memcmp(found.of[i].data(), right.of[i].data(), bytes) == 0) << i;
  }
}

/// Expects that after the change all is found as from nothing, by looking at most this share of the grains.
void expect_renewed(const Heap& before, const Heap& after, double most, const char* what) {
  const std::vector<Kind> kinds = kinds_of(before.grains.kinds, 512, {});
  const Space old_space(before.grains, kinds);
  const Space space(after.grains, kinds);
  Ways ways = ways_in(old_space);
  const std::optional<Moves> moves = Moves::between(before.grains, after.grains);
  ASSERT_TRUE(moves) << what;
  const std::size_t renewed = renew(space, *moves, rays, rays_through, radiance, ways, {});
  EXPECT_GT(renewed, 0U) << what;
  EXPECT_LT(static_cast<double>(renewed), most * static_cast<double>(space.size())) << what;
  const Ways right = ways_in(space);
  expect_same(ways.links, right.links);
  expect_same(ways.behind, right.behind);
  for (std::size_t i = 0; i < space.size(); ++i) {
    EXPECT_EQ(ways.world.direct[i].channels, right.world.direct[i].channels) << i;
    EXPECT_EQ(ways.world.crossed[i].channels, right.world.crossed[i].channels) << i;
  }
}

TEST(Moves, LeaveRaysAsTheyWereThatMeetNothingThatMoved) {
  for (const Optics& optics : {medium(3.0, 0.95), medium(1.0, 0.999), lambert(0.8)}) {
    const Heap heap = lattice(10, optics);
    Heap nudged = heap;
    nudged.grains.grains[555].middle += glm::vec3(0.04F, 0.03F, -0.02F);
    expect_renewed(heap, nudged, optics.transparent() ? 0.5 : 0.2, "one inside");
    Heap lifted = heap;
    lifted.grains.grains.back().middle.z += 5.0F;
    lifted.grains.grains.front().radius = 0.5F;
    expect_renewed(heap, lifted, optics.transparent() ? 0.6 : 0.5, "one lifted and one shrunk");
  }
}

TEST(Moves, AreNoneWhereTooMuchHasChanged) {
  const Heap heap = lattice(6, lambert(0.8));
  Heap fallen = heap;
  for (Grain& grain : fallen.grains.grains) grain.middle.z *= 0.99F;
  EXPECT_FALSE(Moves::between(heap.grains, fallen.grains));
  Heap fewer = heap;
  fewer.grains.grains.pop_back();
  EXPECT_FALSE(Moves::between(heap.grains, fewer.grains));
  Heap other = heap;
  other.grains.kinds = {lambert(0.7)};
  EXPECT_FALSE(Moves::between(heap.grains, other.grains));
}

}  // namespace
}  // namespace mesograin::heap

// Where light came in that leaves a grain.
#include "heap/entries.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "heap/grain_table.h"
#include "heaps.h"

namespace mesograin::heap {
namespace {

const glm::vec3 to_viewer = glm::normalize(glm::vec3(0.2F, 0.1F, 1.0F));

/// The mean way from where light leaves to where it came in, seen from the light, and its mean square.
glm::vec3 mean_offset(const GrainTable& table, const glm::vec3& normal, const glm::vec3& to_light) {
  const std::size_t bin = Entries::bin(normal, to_light, to_viewer);
  glm::vec3 sum(0.0F);
  for (std::size_t i = 0; i < Entries::each; ++i) {
    const glm::vec2 offset = table.came_in().offsets()[bin * Entries::each + i];
    sum += glm::vec3(offset, glm::dot(offset, offset)) / static_cast<float>(Entries::each);
  }
  return sum;
}

TEST(Entries, AreWhereLightLeavesOfWhatIsThick) {
  const GrainTable table(medium(300.0, 0.9), Sense::from_light, {});
  const glm::vec3 normal(0.0F, 0.0F, 1.0F);
  EXPECT_LT(std::sqrt(mean_offset(table, normal, glm::normalize(glm::vec3(0.5F, 0.0F, 1.0F))).z), 0.1F);
}

TEST(Entries, LieAboveTheViewersWayThroughWhatIsThin) {
  // Scattered once, anywhere on the way of the viewer: its middle is half the chord below the surface.
  const GrainTable table(medium(1e-3, 0.5), Sense::from_light, {});
  const glm::vec3 normal = glm::normalize(glm::vec3(0.0F, 0.3F, 1.0F));
  const glm::vec3 to_light(0.7071068F, 0.0F, 0.7071068F);
  const glm::vec3 middle = -glm::dot(normal, to_viewer) * to_viewer;
  const glm::vec3 tangential = normal - glm::dot(normal, to_light) * to_light;
  const glm::vec3 away = glm::normalize(tangential);
  glm::vec3 across = glm::cross(to_light, away);
  if (glm::dot(across, to_viewer) < 0.0F) across = -across;
  const glm::vec3 found = mean_offset(table, normal, to_light);
  // A bin is 15 degrees wide.
  EXPECT_NEAR(found.x, glm::dot(middle, away), 0.15F);
  EXPECT_NEAR(found.y, glm::dot(middle, across), 0.15F);
}

TEST(Entries, AreOnTheLitSide) {
  for (const double sigma_t : {1e-6, 1.0, 50.0}) {
    const GrainTable table(medium(sigma_t, 1.0), Sense::from_light, {}, 512);
    ASSERT_EQ(table.came_in().offsets().size(), Entries::bins * Entries::each);
    for (const glm::vec2& offset : table.came_in().offsets()) {
      ASSERT_TRUE(std::isfinite(offset.x) && std::isfinite(offset.y));
      ASSERT_LE(glm::length(offset), 2.0F + 1e-4F);
    }
  }
}

TEST(Entries, AreOfNoOpaqueGrain) {
  EXPECT_TRUE(GrainTable(lambert(0.5), Sense::from_light, {}).came_in().offsets().empty());
}

}  // namespace
}  // namespace mesograin::heap

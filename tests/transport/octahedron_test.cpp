// Octahedral maps of fewer texels.
#include "transport/octahedron.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <numbers>
#include <numeric>
#include <vector>

namespace mesograin::transport {
namespace {

constexpr int few = 16;
constexpr int few_texels = few * few;

/// Smooth on the sphere, across the map's edges as well.
float height(const glm::vec3& direction) { return direction.z + 0.5F * direction.x; }

TEST(Octahedron, AMapOfFewerTexelsIsSmoothAcrossItsEdges) {
  std::vector<float> heights;
  heights.reserve(few_texels);
  for (int texel = 0; texel < few_texels; ++texel) heights.push_back(height(octahedron_direction(texel, few)));
  const std::vector<float> map = octahedron_map(heights, few);
  ASSERT_EQ(map.size(), std::size_t{octahedron_texels});
  for (int texel = 0; texel < octahedron_texels; ++texel)
    EXPECT_NEAR(map[static_cast<std::size_t>(texel)], height(octahedron_direction(texel)),
                0.05F);  // its creases: 0.035
  EXPECT_EQ(octahedron_map(map, octahedron_side), map);
}

TEST(Octahedron, TexelsFillTheSphere) {
  for (const int side : {few, octahedron_side}) {
    const std::vector<float> angles = octahedron_solid_angles(side);
    EXPECT_EQ(angles.size(), static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    EXPECT_NEAR(std::accumulate(angles.begin(), angles.end(), 0.0), 4.0 * std::numbers::pi, 1e-4);
  }
}

}  // namespace
}  // namespace mesograin::transport

// Rows and columns of the tables against the way back, which fills them.
#include <gtest/gtest.h>

#include "physics/physics.h"

namespace mesograin::physics {
namespace {

TEST(Tables, RowsAndColumnsOfABodyAreFoundAgain) {
  for (int i = 0; i <= 32; ++i) {
    const double share = i / 32.0;
    EXPECT_NEAR(body_row(body_radius(share)), share, 1e-14);
    EXPECT_NEAR(body_column(body_cosine(share)), share, 1e-14);
  }
  EXPECT_EQ(body_radius(0.0), 0.125);
  EXPECT_EQ(body_radius(1.0), 2.0);
  EXPECT_EQ(body_cosine(0.0), -1.0);
  EXPECT_EQ(body_cosine(1.0), 1.0);
}

TEST(Tables, ColumnsOfAKernelAreFoundAgain) {
  for (const double shortest : {1e-6, 0.05, 3.0})
    for (int column = 0; column < 400; ++column) {
      const double distance = kernel_distance(column, shortest, 12.5);
      EXPECT_NEAR(kernel_column(distance, 1.0 / shortest, 12.5), column, 1e-9) << shortest;
    }
}

TEST(Tables, AnEdgeRisesAsItsCircleDoes) {
  // Two points of the unit circle this far apart: 1 - cos(angle / 2) above the chord's middle, of which Phong
  // tessellation finds all but the fourth order.
  const double angle = 0.01;
  const real3 a(0.0, 1.0, 0.0);
  const real3 b(glm::sin(angle), glm::cos(angle), 0.0);
  EXPECT_NEAR(edge_rise(a, a, b, b) / (1.0 - glm::cos(0.5 * angle)), 1.0, 1e-4);
  EXPECT_EQ(edge_rise(a, a, b, a), 0.0);
}

}  // namespace
}  // namespace mesograin::physics

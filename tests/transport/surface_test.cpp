// The surface at nodes of its own: what neighbours tell is what the body itself says, and corners are sharp.
#include "transport/surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <optional>
#include <vector>

#include "shapes.h"
#include "transport/random.h"

namespace mesograin::transport {
namespace {

class SurfaceTest : public testing::Test {
 protected:
  void lay_out(const scene::Mesh& mesh, int nodes) {
    body_.emplace(mesh);
    grid_.emplace(*body_, nodes);
    size_ = surface_size(grid_->size());
    distances_ = surface_distances(*body_, *grid_, {});
  }

  float at(const glm::ivec3& node) const {
    const int index = (node.z * size_.y + node.y) * size_.x + node.x;
    return distances_[static_cast<std::size_t>(index)];
  }

  glm::vec3 place(const glm::vec3& node) const {
    return grid_->lower() + node * grid_->spacing() / static_cast<float>(surface_finer);
  }

  float true_distance(const glm::vec3& where) const {
    const float distance = body_->nearest(where).distance;
    return body_->contains(where) ? -distance : distance;
  }

  std::optional<Body> body_;
  std::optional<Grid> grid_;
  glm::ivec3 size_{0};
  std::vector<float> distances_;
};

TEST_F(SurfaceTest, NodesAreAsFarFromItAsTheyAreToldByNeighbours) {
  lay_out(plates(0.4F, 0.3F), 300);
  ASSERT_EQ(distances_.size(), static_cast<std::size_t>(size_.x * size_.y * size_.z));
  for (int z = 0; z < size_.z; ++z)
    for (int y = 0; y < size_.y; ++y)
      for (int x = 0; x < size_.x; ++x)
        EXPECT_NEAR(at({x, y, z}), true_distance(place({x, y, z})), 1e-5F) << x << " " << y << " " << z;
}

TEST_F(SurfaceTest, NodesDeepBelowItAreToldByThoseAround) {
  lay_out(cube(), 512);
  const float spacing = grid_->spacing().x / static_cast<float>(surface_finer);
  int told = 0;
  for (int z = 0; z < size_.z; ++z)
    for (int y = 0; y < size_.y; ++y)
      for (int x = 0; x < size_.x; ++x) {
        const float distance = true_distance(place({x, y, z}));
        const bool near = std::abs(distance) < 2.0F * spacing;
        EXPECT_NEAR(at({x, y, z}), distance, near ? 1e-5F : spacing) << x << " " << y << " " << z;
        told += std::abs(at({x, y, z}) - distance) > 1e-5F ? 1 : 0;
      }
  EXPECT_GT(told, 100);
}

// In the cell at a cube's corner what is linear between nodes is 3/8 of their spacing off in the middle.
TEST_F(SurfaceTest, CornersAreSharperThanTheLightsNodesWouldTell) {
  lay_out(cube(), 512);
  Random random(1, 0);
  float worst = 0.0F;
  for (int i = 0; i < 20000; ++i) {
    const glm::vec3 node = glm::vec3(random.uniform(), random.uniform(), random.uniform()) * glm::vec3(size_ - 1);
    worst = std::max(worst, std::abs(distance_at(*grid_, distances_, place(node)) - true_distance(place(node))));
  }
  EXPECT_LT(worst, 0.2F * grid_->spacing().x);
}

}  // namespace
}  // namespace mesograin::transport

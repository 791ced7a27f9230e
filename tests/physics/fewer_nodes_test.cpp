// Values at fewer nodes: what is linear stays as it is, and nothing is nearer to what is not.
#include "models/fewer_nodes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace mesograin::models {
namespace {

constexpr glm::ivec3 many(15, 11, 7);
constexpr glm::ivec3 few(10, 8, 5);

std::vector<float> values_at(const glm::ivec3& size, const std::function<float(const glm::vec3&)>& value) {
  std::vector<float> values;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) values.push_back(value(glm::vec3(x, y, z) / glm::vec3(size - 1)));
  return values;
}

/// Between nodes, at a place from 0 to 1 along each side.
float linear(const std::vector<float>& values, const glm::ivec3& size, const glm::vec3& place) {
  const glm::vec3 node = place * glm::vec3(size - 1);
  const glm::ivec3 before = glm::min(glm::ivec3(node), size - 2);
  float sum = 0.0F;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 at = before + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    const glm::vec3 share = 1.0F - glm::abs(node - glm::vec3(at));
    const int node_at = (at.z * size.y + at.y) * size.x + at.x;
    sum += share.x * share.y * share.z * values[static_cast<std::size_t>(node_at)];
  }
  return sum;
}

double sum_of_squares(const std::vector<float>& values, const std::vector<float>& fewer) {
  std::size_t node = 0;
  double sum = 0.0;
  values_at(many, [&](const glm::vec3& place) {
    sum += std::pow(static_cast<double>(linear(fewer, few, place) - values[node++]), 2.0);
    return 0.0F;
  });
  return sum;
}

TEST(FewerNodes, KeepsWhatIsLinear) {
  const auto value = [](const glm::vec3& place) { return glm::dot(place, glm::vec3(1.0F, -2.0F, 0.5F)) + 0.25F; };
  const std::vector<float> fewer = at_fewer_nodes(values_at(many, value), many, few);
  const std::vector<float> expected = values_at(few, value);
  ASSERT_EQ(fewer.size(), expected.size());
  for (std::size_t node = 0; node < fewer.size(); ++node) EXPECT_NEAR(fewer[node], expected[node], 2e-6) << node;
}

TEST(FewerNodes, AreTheNearestOfAll) {
  const std::vector<float> values = values_at(many, [](const glm::vec3& place) {
    return glm::length(place - glm::vec3(0.4F, 0.7F, 0.1F)) - (place.x + place.y < 0.2F ? 0.3F : 0.0F);
  });
  std::vector<float> fewer = at_fewer_nodes(values, many, few);
  const double least = sum_of_squares(values, fewer);
  EXPECT_GT(least, 0.01) << "they cannot tell all";
  for (float& value : fewer)
    for (const float change : {-0.01F, 0.01F}) {
      value += change;
      EXPECT_GT(sum_of_squares(values, fewer), least);
      value -= change;
    }
}

}  // namespace
}  // namespace mesograin::models

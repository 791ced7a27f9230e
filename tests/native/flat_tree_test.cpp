// Walked as a device walks it, a flat tree leads to every box that a place is in, and to nothing twice.
#include "casting/flat_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <random>
#include <vector>

#include "expect_error.h"

namespace mesograin::casting {
namespace {

constexpr unsigned most_depth = 40;

std::vector<Box> boxes_in_disorder(std::size_t count) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<float> place(-10.0F, 10.0F), size(0.0F, 2.0F);
  std::vector<Box> boxes;
  boxes.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3 lower(place(engine), place(engine), place(engine));
    boxes.push_back({lower, lower + glm::vec3(size(engine), size(engine), size(engine))});
  }
  return boxes;
}

bool holds(const glm::vec4& lower, const glm::vec4& upper, const glm::vec3& place) {
  return glm::all(glm::lessThanEqual(glm::vec3(lower), place)) && glm::all(glm::lessThanEqual(place, glm::vec3(upper)));
}

/// The boxes of the leaves whose own boxes hold the place. How deep the way to them is, is told too.
void find(const FlatTree& tree, std::size_t node, const glm::vec3& place, unsigned depth, unsigned& deepest,
          std::vector<std::uint32_t>& found) {
  deepest = std::max(deepest, depth);
  const FlatNode& of = tree.nodes[node];
  const auto look = [&](const glm::vec4& lower, const glm::vec4& upper) {
    if (!holds(lower, upper, place)) return;
    if (lower.w >= 0.0F) {
      find(tree, static_cast<std::size_t>(lower.w), place, depth + 1, deepest, found);
      return;
    }
    const auto first = static_cast<std::size_t>(-1.0F - lower.w);
    for (std::size_t i = 0; i < static_cast<std::size_t>(upper.w); ++i) found.push_back(tree.order[first + i]);
  };
  look(of.first_lower, of.first_upper);
  look(of.second_lower, of.second_upper);
}

TEST(FlatTree, LeadsToEveryBoxThatHoldsAPlace) {
  for (const std::size_t most_in_leaf : {1U, 2U})
    for (const std::size_t count : {3U, 1000U, 20000U}) {
      const std::vector<Box> boxes = boxes_in_disorder(count);
      const FlatTree tree = flat_tree(boxes, most_in_leaf, most_depth);
      EXPECT_EQ(tree.order.size(), count);
      unsigned deepest = 0;
      for (std::size_t i = 0; i < count; i += count / 100 + 1) {
        const glm::vec3 place = 0.5F * (boxes[i].lower + boxes[i].upper);
        std::vector<std::uint32_t> found;
        find(tree, 0, place, 1, deepest, found);
        EXPECT_EQ(std::count(found.begin(), found.end(), i), 1);
      }
      EXPECT_LE(deepest, most_depth);
    }
}

TEST(FlatTree, OfOneBoxOrNoneIsATree) {
  std::vector<std::uint32_t> found;
  unsigned deepest = 0;
  find(flat_tree({{glm::vec3(-1.0F), glm::vec3(1.0F)}}, 1, most_depth), 0, glm::vec3(0.0F), 1, deepest, found);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(std::count(found.begin(), found.end(), 0U), static_cast<std::ptrdiff_t>(found.size()));
  found.clear();
  find(flat_tree({}, 1, most_depth), 0, glm::vec3(0.0F), 1, deepest, found);
  EXPECT_TRUE(found.empty());
}

// Any number of them in one place cannot be told apart, and are halved.
TEST(FlatTree, OfManyEqualBoxesIsShallow) {
  const FlatTree tree = flat_tree(std::vector<Box>(5000, Box{glm::vec3(0.0F), glm::vec3(1.0F)}), 1, most_depth);
  std::vector<std::uint32_t> found;
  unsigned deepest = 0;
  find(tree, 0, glm::vec3(0.5F), 1, deepest, found);
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found.size(), 5000U);
  EXPECT_EQ(std::unique(found.begin(), found.end()), found.end());
}

TEST(FlatTree, BoxesThatNeedALongWayAreRefused) {
  std::vector<Box> boxes;
  boxes.reserve(60);
  for (int i = 0; i < 60; ++i) boxes.push_back({glm::vec3(0.0F), glm::vec3(std::exp2(static_cast<float>(i)))});
  test::expect_error([&] { flat_tree(boxes, 1, 9); }, "too unequal");
}

}  // namespace
}  // namespace mesograin::casting

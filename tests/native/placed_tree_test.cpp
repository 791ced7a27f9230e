// A ray alone finds what it finds in a packet.
#include "casting/placed_tree.h"

#include <gtest/gtest.h>

#include <array>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "scene/sphere.h"

namespace mesograin::casting {
namespace {

constexpr std::uint32_t count = 20;

/// Balls of three sizes in disorder, the last ones in a group of their own.
class Balls {
 public:
  Balls() {
    std::mt19937 engine(1);
    std::uniform_real_distribution<float> place(-4.0F, 4.0F);
    for (std::uint32_t i = 0; i < count; ++i) {
      const float size = 0.5F * static_cast<float>(1 + i % 3);
      rows_.insert(
          rows_.end(),
          {{size, 0.0F, 0.0F, place(engine)}, {0.0F, 0.0F, -size, place(engine)}, {0.0F, size, 0.0F, place(engine)}});
    }
    const auto mesh = std::make_shared<const MeshTree>(scene::unit_sphere(32, 16));
    constexpr std::uint32_t first = 15;
    tree_ = std::make_unique<PlacedTree>(std::vector<PlacedGroup>{
        {mesh, rows_.data(), first, 0}, {mesh, rows_.data() + 3 * first, count - first, first}});
  }

  const PlacedTree& tree() const { return *tree_; }
  glm::vec3 middle(std::uint32_t ball) const {
    return {rows_[3 * ball].w, rows_[3 * ball + 1].w, rows_[3 * ball + 2].w};
  }

 private:
  std::vector<glm::vec4> rows_;
  std::unique_ptr<PlacedTree> tree_;
};

std::optional<Hit> in_a_packet(const PlacedTree& tree, const SingleRay& ray) {
  Packet packet;
  Hits hits;
  packet.set(3, ray.origin, ray.direction, ray.farthest);
  packet.from[3] = ray.from;
  packet.own[3] = ray.own;
  tree.first_hits(packet, hits);
  if (!hits.met[3]) return std::nullopt;
  return hits.of(3);
}

TEST(PlacedTree, FindsForARayAloneWhatItFindsInAPacket) {
  const Balls balls;
  std::mt19937 engine(2);
  std::normal_distribution<float> any;
  const auto direction = [&] { return glm::normalize(glm::vec3(any(engine), any(engine), any(engine))); };
  int met = 0;
  for (std::uint32_t i = 0; i < 400; ++i) {
    SingleRay ray{balls.middle(i % count), direction()};
    // From inside a ball: past it, or to its own surface; or as far as there.
    if (i % 2 == 0) ray.from = i % count;
    if (i % 4 == 0) ray.own = 1e-3F;
    if (i % 3 == 0) ray.farthest = 2.0F;
    const std::optional<Hit> alone = balls.tree().first_hit(ray);
    const std::optional<Hit> right = in_a_packet(balls.tree(), ray);
    ASSERT_EQ(alone.has_value(), right.has_value()) << i;
    if (!alone) continue;
    ++met;
    EXPECT_EQ(alone->number, right->number) << i;
    EXPECT_EQ(alone->group, right->group) << i;
    EXPECT_NEAR(alone->distance, right->distance, 1e-4F) << i;
  }
  EXPECT_GT(met, 200);
}

TEST(PlacedTree, TakesAnInstanceScaledFlatAndRaysThatAreNoNumbers) {
  // Scaled to nothing along one axis, then turned: what is left of the determinant is rounding.
  const glm::dmat3 turn = glm::dmat3(glm::rotate(glm::dmat4(1.0), 0.7, glm::normalize(glm::dvec3(1.0, 2.0, 3.0))));
  std::vector<glm::vec4> rows;
  for (const double thickness : {0.0, 1e-30, 1e-17}) {
    const glm::dmat3 flat = turn * glm::dmat3(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, thickness);
    for (int row = 0; row < 3; ++row) rows.emplace_back(flat[0][row], flat[1][row], flat[2][row], 0.0);
  }
  const auto mesh = std::make_shared<const MeshTree>(scene::unit_sphere(32, 16));
  const PlacedTree flat({{mesh, rows.data(), 3, 0}});
  const Balls balls;
  constexpr float no_number = std::numeric_limits<float>::quiet_NaN();
  std::mt19937 engine(3);
  std::normal_distribution<float> any;
  for (int i = 0; i < 400; ++i) {
    const glm::vec3 direction = glm::normalize(glm::vec3(any(engine), any(engine), any(engine)));
    const SingleRay ray{-3.0F * direction, direction};
    in_a_packet(flat, ray);
    for (const std::uint32_t instance : {0U, 1U, 2U}) flat.hit_of(instance, ray, 0.0F);
    flat.first_hit(ray);
  }
  for (const SingleRay& ray :
       {SingleRay{glm::vec3(0.0F), glm::vec3(no_number)}, SingleRay{glm::vec3(no_number), glm::vec3(0.0F, 0.0F, 1.0F)},
        SingleRay{glm::vec3(0.0F, 0.0F, -1e30F), glm::vec3(0.0F, 0.0F, 1.0F)}}) {
    EXPECT_FALSE(balls.tree().first_hit(ray));
    EXPECT_FALSE(in_a_packet(balls.tree(), ray));
    EXPECT_FALSE(balls.tree().hit_of(0, ray, 0.0F));
  }
}

TEST(PlacedTree, FindsOneInstanceWhateverStandsBeforeIt) {
  const Balls balls;
  for (std::uint32_t ball = 0; ball < count; ++ball) {
    const glm::vec3 from(30.0F, 1.0F, 2.0F);
    const glm::vec3 towards = glm::normalize(balls.middle(ball) - from);
    const float far = glm::distance(from, balls.middle(ball));
    const float size = 0.5F * static_cast<float>(1 + ball % 3);
    const std::optional<Hit> before = balls.tree().hit_of(ball, {from, towards}, 0.0F);
    const std::optional<Hit> behind = balls.tree().hit_of(ball, {from, towards}, far);
    ASSERT_TRUE(before && behind) << ball;
    EXPECT_EQ(before->number, ball);
    EXPECT_NEAR(before->distance, far - size, 0.03F * size) << ball;
    EXPECT_NEAR(behind->distance, far + size, 0.03F * size) << ball;
    EXPECT_FALSE(balls.tree().hit_of(ball, {from, -towards}, 0.0F)) << ball;
  }
}

TEST(PlacedTree, MayReachWhateverItReaches) {
  // A flat ground, sheared and aslant.
  const std::vector<glm::vec4> rows{{2.0F, 0.5F, 0.0F, 1.0F}, {-0.5F, 2.0F, 0.3F, -1.0F}, {0.0F, 0.7F, 1.0F, 0.5F}};
  const glm::vec3 upwards(0.0F, 0.0F, 1.0F);
  const scene::Mesh square({{-1.0F, -1.0F, 0.0F}, {1.0F, -1.0F, 0.0F}, {1.0F, 1.0F, 0.0F}, {-1.0F, 1.0F, 0.0F}},
                           std::vector<glm::vec3>(4, upwards), {{0, 1, 2}, {0, 2, 3}});
  const PlacedTree tree({{std::make_shared<const MeshTree>(square), rows.data(), 1, 0}});
  const auto placed = [&](const glm::vec3& at) {
    return glm::vec3(glm::dot(glm::vec3(rows[0]), at) + rows[0].w, glm::dot(glm::vec3(rows[1]), at) + rows[1].w,
                     glm::dot(glm::vec3(rows[2]), at) + rows[2].w);
  };
  const glm::vec3 up = glm::normalize(glm::cross(placed({1.0F, 0.0F, 0.0F}) - placed({0.0F, 0.0F, 0.0F}),
                                                 placed({0.0F, 1.0F, 0.0F}) - placed({0.0F, 0.0F, 0.0F})));
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> inside(-1.0F, 1.0F);
  for (int i = 0; i < 100; ++i) {
    const glm::vec3 on = placed({inside(engine), inside(engine), 0.0F});
    EXPECT_TRUE(tree.may_reach(on + 0.3F * up, 0.301F)) << i;
    EXPECT_FALSE(tree.may_reach(on - 0.3F * up, 0.299F)) << i;
  }
  EXPECT_FALSE(tree.may_reach({50.0F, 0.0F, 0.5F}, 1.0F));
}

}  // namespace
}  // namespace mesograin::casting

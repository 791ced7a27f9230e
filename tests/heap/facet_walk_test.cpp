// Light at a rough surface, walked from facet to facet, against the BRDF of its facets' first meeting.
#include "heap/facet_walk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "physics/physics.h"

namespace mesograin::heap {
namespace {

/// The plane z = 0 of a medium below it that has no end.
class Plane : public Facets {
 public:
  explicit Plane(float alpha) : alpha_(alpha) {}

  std::optional<Meeting> inside(std::uint32_t, const glm::vec3&, const glm::vec3&) const override {
    return std::nullopt;
  }
  std::optional<Meeting> beyond(std::uint32_t, const glm::vec3&, const glm::vec3&) const override {
    return std::nullopt;
  }
  Finish finish(std::uint32_t) const override { return {alpha_, true, true}; }

 private:
  float alpha_;
};

constexpr double eta = 1.5;
constexpr int walks = 400'000;

glm::dvec3 direction(double polar, double azimuth) {
  return {std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar)};
}

struct Shares {
  double reflected = 0.0;
  double near_mirror = 0.0;
};

constexpr double cone = 0.2;

Shares walked(double polar, float alpha) {
  Optics glass;
  glass.surface = Surface::dielectric;
  glass.eta = eta;
  const glm::vec3 towards(direction(polar, 0.0));
  const glm::vec3 mirror(-towards.x, -towards.y, towards.z);
  const SeenFacet seen{0, glm::vec3(0.0F), {0.0F, 0.0F, 1.0F}, towards};
  transport::Random random(7, 0);
  Shares shares;
  for (int i = 0; i < walks; ++i) {
    const std::optional<Passage> passage = walk_facets(glass, 1.0F, seen, Plane(alpha), Scatterings::end, random);
    EXPECT_TRUE(passage);
    EXPECT_EQ(passage->direction.z > 0.0F, !passage->entered);
    if (passage->entered) continue;
    shares.reflected += 1.0 / walks;
    if (glm::dot(passage->direction, mirror) > std::cos(cone)) shares.near_mirror += 1.0 / walks;
  }
  return shares;
}

/// What one facet reflects.
Shares once_reflected(double polar, double alpha) {
  const glm::dvec3 normal(0.0, 0.0, 1.0);
  const glm::dvec3 towards = direction(polar, 0.0);
  const glm::dvec3 mirror(-towards.x, -towards.y, towards.z);
  Shares shares;
  constexpr int steps = 1200;
  const double step = 0.5 * std::numbers::pi / steps;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < 4 * steps; ++j) {
      const glm::dvec3 on = direction((i + 0.5) * step, (j + 0.5) * step);
      const double share = step * step * std::sin((i + 0.5) * step) * on.z *
                           physics::dielectric_reflection(normal, on, on.z, towards, towards.z, eta, alpha, true);
      shares.reflected += share;
      if (glm::dot(on, mirror) > std::cos(cone)) shares.near_mirror += share;
    }
  return shares;
}

// What a facet hides of another's light goes on, most of it elsewhere.
TEST(FacetWalk, ReflectsAsRoughFacetsDo) {
  for (const float alpha : {0.1F, 0.5F})
    for (const double polar : {0.2, 1.2}) {
      const Shares found = walked(polar, alpha);
      const Shares once = once_reflected(polar, alpha);
      const double noise = 4.0 * std::sqrt(once.near_mirror / walks);
      EXPECT_NEAR(found.near_mirror, 1.02 * once.near_mirror, 0.03 * once.near_mirror + noise) << alpha << " " << polar;
      EXPECT_GT(found.reflected, once.reflected - noise) << alpha << " " << polar;
      EXPECT_LT(found.reflected, 1.5 * once.reflected) << alpha << " " << polar;
    }
}

/// What goes on beyond the surface, in all and near where a smooth one would send it.
struct Beyond {
  double all = 0.0;
  double near = 0.0;
};

glm::dvec3 refracted(const glm::dvec3& travelling, double relative) {
  const glm::dvec3 across = glm::dvec3(travelling.x, travelling.y, 0.0) / relative;
  return {across.x, across.y, -std::sqrt(1.0 - glm::dot(across, across))};
}

Beyond walked_beyond(double polar, float alpha, double relative) {
  Optics medium;
  medium.surface = Surface::dielectric;
  medium.eta = relative;
  const glm::dvec3 towards = direction(polar, 0.0);
  const glm::dvec3 smooth = refracted(-towards, relative);
  const SeenFacet seen{0, glm::vec3(0.0F), {0.0F, 0.0F, 1.0F}, glm::vec3(towards)};
  transport::Random random(11, 0);
  Beyond beyond;
  for (int i = 0; i < walks; ++i) {
    const std::optional<Passage> passage = walk_facets(medium, 1.0F, seen, Plane(alpha), Scatterings::end, random);
    if (!passage->entered) continue;
    beyond.all += 1.0 / walks;
    if (glm::dot(glm::dvec3(passage->direction), smooth) > std::cos(0.5 * cone)) beyond.near += 1.0 / walks;
  }
  return beyond;
}

Beyond once_beyond(double polar, double alpha, double relative) {
  const glm::dvec3 normal(0.0, 0.0, 1.0);
  const glm::dvec3 travelling = -direction(polar, 0.0);
  const glm::dvec3 smooth = refracted(travelling, relative);
  Beyond beyond;
  constexpr int steps = 1200;
  const double step = 0.5 * std::numbers::pi / steps;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < 4 * steps; ++j) {
      const glm::dvec3 on = -direction((i + 0.5) * step, (j + 0.5) * step);
      const double share =
          step * step * std::sin((i + 0.5) * step) * leaving_density(normal, alpha, relative, travelling, on);
      beyond.all += share;
      if (glm::dot(on, smooth) > std::cos(0.5 * cone)) beyond.near += share;
    }
  return beyond;
}

// One facet sends less than all do: what others reflect or hide goes on.
TEST(FacetWalk, LeavesAsLikelyAsIsTold) {
  for (const double relative : {eta, 1.0 / eta})
    for (const float alpha : {0.1F, 0.4F})
      for (const double polar : {0.1, 0.6}) {
        const Beyond found = walked_beyond(polar, alpha, relative);
        const Beyond once = once_beyond(polar, alpha, relative);
        EXPECT_NEAR(found.near, once.near, 0.03 * once.near) << relative << " " << alpha << " " << polar;
        EXPECT_LE(once.all, found.all + 0.003) << relative << " " << alpha << " " << polar;
        EXPECT_GE(once.all, 0.9 * found.all) << relative << " " << alpha << " " << polar;
      }
}

TEST(FacetWalk, ReflectsAsFresnelHasItWhereItIsSmooth) {
  for (const double polar : {0.2, 1.2}) {
    const Shares found = walked(polar, 0.0F);
    EXPECT_NEAR(found.reflected, physics::fresnel_reflectance(std::cos(polar), eta), 0.003);
    EXPECT_DOUBLE_EQ(found.near_mirror, found.reflected);
  }
}

}  // namespace
}  // namespace mesograin::heap

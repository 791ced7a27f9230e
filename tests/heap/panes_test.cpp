// Panes against what must hold of them: a sheet of glass is known exactly, and so is a ball amid a hollow one.
#include "heap/panes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "heap/exchange.h"
#include "heaps.h"
#include "physics/physics.h"

namespace mesograin::heap {
namespace {

constexpr float outer = 10.0F;
constexpr float thickness = 0.5F;

/// Spheres of these radii as one closed surface, the second turned inside out.
scene::MeshPointer shell(float radius, float inner) {
  constexpr unsigned rings = 96;
  constexpr unsigned sectors = 192;
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
  for (const float of : {radius, inner}) {
    const auto begin = static_cast<unsigned>(positions.size());
    for (unsigned ring = 0; ring <= rings; ++ring)
      for (unsigned sector = 0; sector < sectors; ++sector) {
        const double polar = std::numbers::pi * static_cast<double>(ring) / rings;
        const double azimuth = 2.0 * std::numbers::pi * sector / sectors;
        positions.emplace_back(of * std::sin(polar) * std::cos(azimuth), of * std::sin(polar) * std::sin(azimuth),
                               of * std::cos(polar));
      }
    const bool inside_out = of == inner;
    for (unsigned ring = 0; ring < rings; ++ring)
      for (unsigned sector = 0; sector < sectors; ++sector) {
        const unsigned a = begin + ring * sectors + sector;
        const unsigned b = begin + ring * sectors + (sector + 1) % sectors;
        const auto add = [&](unsigned p, unsigned q, unsigned r) {
          triangles.emplace_back(p, inside_out ? r : q, inside_out ? q : r);
        };
        add(a, a + sectors, b);
        add(b, a + sectors, b + sectors);
      }
  }
  return std::make_shared<const scene::Mesh>(std::move(positions), std::vector<glm::vec3>{}, std::move(triangles));
}

/// A ball amid a hollow one of glass, in an even white world.
Heap ball_in_glass(const Optics& ball, const Glass& glass) {
  Heap heap;
  heap.grains.kinds = {ball, lambert(0.0)};
  heap.grains.grains = {{glm::vec3(0.0F), 1.0F, 0}, {glm::vec3(0.0F, 0.0F, outer), 1e-6F, 1}};
  heap.grains.panes = {{shell(outer, outer - thickness), glm::dmat4(1.0), 1, glass}};
  heap.world.radiance = glm::dvec3(1.0);
  return heap;
}

HeapLight solved(const Heap& heap, int rays = 1 << 14) {
  Quality quality;
  quality.rays = quality.light_rays = rays;
  return solve_exchange(heap, quality, {}, {});
}

TEST(Sheet, KeepsAllLightOfClearGlass) {
  for (const float eta : {1.0F, 1.33F, 1.5F, 2.4F})
    for (const float cosine : {0.0F, 1e-6F, 0.01F, 0.3F, 0.7F, 1.0F}) {
      const Sheet glass = sheet({glm::vec3(0.0F), eta}, cosine, 0.1F);
      EXPECT_NEAR(glass.left().r, 1.0F, 2e-5F) << eta << ", " << cosine;
      EXPECT_GE(glass.passed.r, 0.0F);
    }
}

TEST(Sheet, LosesWhatAbsorbsOnTheRefractedWay) {
  const glm::vec3 sigma_a(0.0F, 0.5F, 3.0F);
  constexpr float depth = 0.4F;
  for (const float cosine : {0.2F, 0.6F, 1.0F}) {
    const Sheet glass = sheet({sigma_a, 1.5F}, cosine, depth / cosine);
    // Each surface met in turn.
    const auto r = static_cast<float>(physics::fresnel_reflectance(cosine, 1.5));
    const float way = depth / std::sqrt(1.0F - (1.0F - cosine * cosine) / 2.25F);
    const glm::vec3 left = glm::exp(-sigma_a * way);
    glm::vec3 passed(0.0F);
    glm::vec3 reflected(r);
    glm::vec3 inside = (1.0F - r) * left;
    for (int met = 0; met < 200; ++met) {
      (met % 2 == 0 ? passed : reflected) += (1.0F - r) * inside;
      inside *= r * left;
    }
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(glass.passed[channel], passed[channel], 1e-5F);
      EXPECT_NEAR(glass.reflected[channel], reflected[channel], 1e-5F);
    }
  }
}

TEST(Panes, KeepAWhiteFurnaceEven) {
  const HeapLight light = solved(ball_in_glass(lambert(1.0), {glm::vec3(0.0F), 1.5F}));
  EXPECT_NEAR(light.sent[0].channels[0].w, 1.0F, 2e-3F);
}

TEST(Panes, ColourWhatStandsInThem) {
  const Glass green{glm::vec3(2.0F, 0.2F, 1.0F), 1.5F};
  constexpr float reflectance = 0.6F;
  const HeapLight light = solved(ball_in_glass(lambert(reflectance), green));
  // What the ball sees lies straight above it: the world through the sheet, and itself in the sheet's mirror. From a
  // place of a ball that is not small a part of it lies aside.
  const Sheet above = sheet(green, 1.0F, thickness);
  for (int channel = 0; channel < 3; ++channel) {
    const float seen = reflectance * above.passed[channel] / (1.0F - reflectance * above.reflected[channel]);
    EXPECT_NEAR(light.sent[0].channels[static_cast<std::size_t>(channel)].w, seen, 0.02F * seen);
  }
}

TEST(Panes, AreNumbersAtTheExtremes) {
  for (const float eta : {0.6F, 1.0F, 1.0000001F, 1e4F})
    for (const float sigma_a : {0.0F, 1e-12F, 1e12F}) {
      // Fewer rays tell as well whether it is a number, and in such glass they are followed for long.
      const HeapLight light = solved(ball_in_glass(lambert(0.5), {glm::vec3(sigma_a), eta}), 1 << 11);
      const float sent = light.sent[0].channels[0].w;
      EXPECT_TRUE(std::isfinite(sent) && sent >= 0.0F && sent < 0.52F) << eta << ", " << sigma_a << ": " << sent;
    }
}

TEST(Panes, FaceOutwardsInMirrorImages) {
  const Glass green{glm::vec3(2.0F, 0.2F, 1.0F), 1.5F};
  Heap heap = ball_in_glass(lambert(0.5), green);
  const HeapLight light = solved(heap);
  heap.grains.panes[0].to_heap[0][0] = -1.0;
  const HeapLight mirrored = solved(heap);
  for (std::size_t channel = 0; channel < 3; ++channel)
    EXPECT_NEAR(mirrored.sent[0].channels[channel].w, light.sent[0].channels[channel].w, 2e-3F);
}

TEST(Panes, LetTheLightOfASunThrough) {
  const Glass green{glm::vec3(2.0F, 0.2F, 1.0F), 1.5F};
  Heap heap = ball_in_glass(lambert(0.5), green);
  heap.world.radiance = glm::dvec3(0.0);
  heap.lights = {scene::DirectionalLight{glm::dvec3(0.0, 0.0, 1.0), glm::dvec3(1.0), 0.0}};
  const HeapLight within = solved(heap);
  heap.grains.panes.clear();
  const HeapLight alone = solved(heap);
  const Sheet above = sheet(green, 1.0F, thickness);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const auto i = static_cast<int>(channel);
    // And what the ball sends up comes back, a little.
    const float share = within.sent[0].channels[channel].w / alone.sent[0].channels[channel].w;
    EXPECT_GT(share, 0.98F * above.passed[i]);
    EXPECT_LT(share, above.passed[i] * (1.0F + 1.2F * above.reflected[i]));
  }
}

}  // namespace
}  // namespace mesograin::heap

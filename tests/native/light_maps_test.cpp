// Light maps of a sphere and of a concave mesh against their geometry.
#include "render/light_maps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "gl/context_thread.h"
#include "render/device_cache.h"
#include "render/light_map_atlas.h"

namespace mesograin::render {
namespace {

// Axis-aligned boxes as one mesh, with face normals.
scene::MeshPointer boxes(const std::vector<std::pair<glm::vec3, glm::vec3>>& corners) {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;
  std::vector<glm::uvec3> triangles;
  for (const auto& [lower, upper] : corners) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int side = 0; side < 2; ++side) {
        const auto first = static_cast<unsigned>(positions.size());
        for (int corner = 0; corner < 4; ++corner) {
          glm::vec3 point;
          point[axis] = side == 1 ? upper[axis] : lower[axis];
          const int u = (axis + 1) % 3;
          const int v = (axis + 2) % 3;
          point[u] = (corner == 1 || corner == 2) ? upper[u] : lower[u];
          point[v] = corner >= 2 ? upper[v] : lower[v];
          positions.push_back(point);
          glm::vec3 normal(0.0F);
          normal[axis] = side == 1 ? 1.0F : -1.0F;
          normals.push_back(normal);
        }
        if (side == 1) {
          triangles.emplace_back(first, first + 1, first + 2);
          triangles.emplace_back(first, first + 2, first + 3);
        } else {
          triangles.emplace_back(first, first + 2, first + 1);
          triangles.emplace_back(first, first + 3, first + 2);
        }
      }
    }
  }
  return std::make_shared<scene::Mesh>(positions, normals, triangles);
}

struct Map {
  int resolution;
  std::vector<float> texels;
  const float* centre() const {
    const auto middle = static_cast<std::size_t>(resolution / 2);
    return texels.data() + (middle * static_cast<std::size_t>(resolution) + middle) * 4;
  }
  const float* corner() const { return texels.data(); }
};

Map draw(const scene::MeshPointer& mesh, const glm::dmat4& object_to_grain, const glm::dvec3& to_light,
         int resolution) {
  return gl::ContextThread::instance().run([&] {
    const gl::VertexArray device(mesh->positions(), mesh->normals(), {}, mesh->triangles());
    DeviceCache cache;
    const auto program = [&](bool tessellated) -> const gl::Program& { return cache.light_map_program(tessellated); };
    LightMaps maps(mesh, object_to_grain);
    EXPECT_EQ(maps.update(device, program, {to_light}, resolution), 1);
    EXPECT_EQ(maps.update(device, program, {to_light}, resolution), 0) << "an unchanged grain costs nothing";
    EXPECT_EQ(maps.update(device, program, {to_light}, resolution / 2), 0) << "a finer map serves";
    return Map{maps.resolution(), maps.read(0)};
  });
}

TEST(LightMaps, HoldEntryNormalAndExitOfABox) {
  const Map map = draw(boxes({{{-1, -2, -3}, {1, 2, 3}}}), glm::dmat4(1.0), {0, 0, 1}, 64);
  EXPECT_FLOAT_EQ(map.centre()[0], 3.0F);
  EXPECT_FLOAT_EQ(map.centre()[1], 0.0F);
  EXPECT_FLOAT_EQ(map.centre()[2], 0.0F);
  EXPECT_FLOAT_EQ(map.centre()[3], -3.0F);
  EXPECT_LT(map.corner()[0], -1e30F) << "the light passes beside the grain here";
}

TEST(LightMaps, OfAConcaveGrainSeeTheFirstSurfaceAndTheFirstExit) {
  // Two slabs with a gap: the light enters at 3 and first leaves at 2, whatever comes behind.
  const Map map = draw(boxes({{{-1, -1, -3}, {1, 1, -2}}, {{-1, -1, 2}, {1, 1, 3}}}), glm::dmat4(1.0), {0, 0, 1}, 64);
  EXPECT_FLOAT_EQ(map.centre()[0], 3.0F);
  EXPECT_FLOAT_EQ(map.centre()[3], 2.0F);
}

// A unit sphere of flat triangles whose corners have the sphere's normals.
scene::MeshPointer coarse_sphere(int segments, int rings) {
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
  for (int ring = 0; ring <= rings; ++ring)
    for (int segment = 0; segment <= segments; ++segment) {
      const double polar = glm::pi<double>() * ring / rings;
      const double azimuth = glm::two_pi<double>() * segment / segments;
      positions.emplace_back(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar));
    }
  for (int ring = 0; ring < rings; ++ring)
    for (int segment = 0; segment < segments; ++segment) {
      const auto a = static_cast<unsigned>(ring * (segments + 1) + segment);
      const unsigned b = a + static_cast<unsigned>(segments) + 1;
      triangles.emplace_back(a, b, b + 1);
      triangles.emplace_back(a, b + 1, a + 1);
    }
  return std::make_shared<scene::Mesh>(positions, positions, triangles);
}

TEST(LightMaps, OfACoarseMeshAreOfTheCurvedSurfaceItsNormalsTellOf) {
  const Map map = draw(coarse_sphere(24, 12), glm::dmat4(1.0), glm::normalize(glm::dvec3(1.0, 0.4, 0.3)), 512);
  std::size_t lit = 0;
  double farthest = 0.0;
  for (std::size_t i = 0; i < map.texels.size(); i += 4) {
    const double height = map.texels[i];
    if (height < 0.3) continue;
    ++lit;
    // On the unit sphere a place is its normal. The triangles' middles lie 0.014 below.
    const double sine_squared = std::pow(map.texels[i + 1], 2) + std::pow(map.texels[i + 2], 2);
    farthest = std::max(farthest, std::abs(height - std::sqrt(1.0 - sine_squared)));
  }
  EXPECT_GT(lit, 150000U);
  EXPECT_LT(farthest, 0.002);
}

TEST(LightMaps, FollowScaleAndMirroring) {
  const glm::dmat4 transform = glm::scale(glm::dmat4(1.0), glm::dvec3(-2.0, 2.0, 2.0));
  const Map map = draw(boxes({{{-1, -1, -1}, {1, 1, 1}}}), transform, {0, 0, 1}, 64);
  EXPECT_FLOAT_EQ(map.centre()[0], 2.0F);
  EXPECT_FLOAT_EQ(map.centre()[3], -2.0F);
}

TEST(LightMaps, CoveredAreaIsTheProjectedArea) {
  const glm::dvec3 to_light = glm::normalize(glm::dvec3(1, 1, 1));
  const Map map = draw(boxes({{{-1, -1, -1}, {1, 1, 1}}}), glm::dmat4(1.0), to_light, 512);
  std::size_t lit = 0;
  for (std::size_t i = 0; i < map.texels.size(); i += 4) lit += map.texels[i] > -1e30F ? 1 : 0;
  // Seen along its diagonal a cube of edge 2 is a regular hexagon of area 4 sqrt 3 and width 2 sqrt(8/3).
  const double half_width = std::sqrt(8.0 / 3.0) * (1.0 + 2.0 / 512);
  const double area = static_cast<double>(lit) * std::pow(2.0 * half_width / 512, 2);
  EXPECT_NEAR(area, 4.0 * std::sqrt(3.0), 0.03);
}

TEST(LightMaps, ResolutionFollowsScreenAndOpticalThickness) {
  EXPECT_EQ(light_map_resolution(1.0, 1.0), 256);
  EXPECT_EQ(light_map_resolution(400.0, 1.0), 512);
  EXPECT_EQ(light_map_resolution(1.0, 100.0), 512);
  EXPECT_EQ(light_map_resolution(1e9, 1e9), 1024);
}

TEST(LightMapDirections, ACoarserGridServesAllThatAreAskedFor) {
  LightMapDirections all;
  all.ask_for_all();
  EXPECT_EQ(all.coarse().asked(), 81);
  LightMapDirections some;
  some.ask_for(glm::normalize(glm::dvec3(0.3, -0.5, 0.8)));
  some.ask_for(glm::normalize(glm::dvec3(-0.7, 0.1, -0.2)));
  const LightMapDirections coarse = some.coarse();
  EXPECT_EQ(some.asked(), 6);
  EXPECT_LE(coarse.asked(), 6);
  for (int node = 0; node < LightMapDirections::count; ++node) {
    const int next = LightMapDirections::coarse(node);
    EXPECT_EQ(LightMapDirections::coarse(next), next);
    EXPECT_GT(glm::dot(LightMapDirections::direction(node), LightMapDirections::direction(next)),
              std::cos(0.53));  // a diagonal of a cell, where the map is widest
    EXPECT_TRUE(coarse.is_asked_for(next) || !some.is_asked_for(node));
  }
}

}  // namespace
}  // namespace mesograin::render

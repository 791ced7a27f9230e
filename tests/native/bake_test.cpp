// Baked textures against what can be computed by hand: which texel shows which point, and seen from where.
#include "render/bake.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "expect_error.h"
#include "gl/context_thread.h"
#include "render/view.h"
#include "scene/sphere.h"

namespace mesograin::render {
namespace {

using test::expect_error;

constexpr double pi = 3.14159265358979323846;

/// A unit square that faces z, with its lower left corner at `lower` in the texture and its upper right at `upper`.
scene::MeshPointer square(glm::vec2 lower, glm::vec2 upper, bool with_uvs = true) {
  std::vector<glm::vec2> uvs;
  if (with_uvs) uvs = {lower, {upper.x, lower.y}, upper, {lower.x, upper.y}};
  return std::make_shared<scene::Mesh>(std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                                       std::vector<glm::vec3>(4, glm::vec3(0, 0, 1)),
                                       std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}}, uvs);
}

scene::Material lambert(double reflectance) {
  scene::Material material;
  material.reflectance = glm::dvec3(reflectance);
  return material;
}

class BakeTest : public testing::Test {
 protected:
  static constexpr int side = 8;

  void TearDown() override { EXPECT_TRUE(gl::ContextThread::instance().take_gl_errors().empty()); }

  std::vector<float> bake(const scene::Scene& scene, const Bake& what, int samples = 4) {
    view_.set_scene(scene);
    view_.set_bake(what);
    view_.render(samples);
    std::vector<float> texels(static_cast<std::size_t>(view_.width()) * static_cast<std::size_t>(view_.height()) * 4);
    view_.read(texels.data());
    return texels;
  }

  const float* texel(const std::vector<float>& texels, int x, int y) const {
    return texels.data() +
           (static_cast<std::size_t>(y) * static_cast<std::size_t>(view_.width()) + static_cast<std::size_t>(x)) * 4;
  }

  scene::DirectionalLight light_{{0, 0, 1}, {pi, pi, pi}};
  View view_{side, side};
};

TEST_F(BakeTest, TexelsLieWhereTheUvsSayAndVIsUp) {
  const scene::Scene scene{{{square({0.25F, 0.5F}, {0.75F, 1.0F}), lambert(0.25)}}, {light_}};
  const std::vector<float> texels = bake(scene, {{0}});
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const bool inside = x >= 2 && x < 6 && y < 4;
      EXPECT_EQ(texel(texels, x, y)[3], inside ? 1.0F : 0.0F) << x << ", " << y;
      EXPECT_FLOAT_EQ(texel(texels, x, y)[0], inside ? 0.25F : 0.0F) << x << ", " << y;
    }
}

TEST_F(BakeTest, EachTexelShowsThePointThatItsUvNames) {
  // The normal leans from +x at the square's left to +z at its right, so brightness tells how far to the right.
  scene::MeshPointer flat = square({0, 0}, {1, 1});
  const glm::vec3 left(1, 0, 0);
  const glm::vec3 right(0, 0, 1);
  auto mesh = std::make_shared<scene::Mesh>(flat->positions(), std::vector<glm::vec3>{left, right, right, left},
                                            flat->triangles(), flat->uvs());
  const std::vector<float> texels = bake({{{mesh, lambert(1.0)}}, {light_}}, {{0}}, 256);
  for (int x = 0; x < side; ++x) {
    constexpr int parts = 64;
    double expected = 0.0;
    for (int part = 0; part < parts; ++part) {
      const double u = (x + (part + 0.5) / parts) / side;
      expected += u / std::hypot(u, 1.0 - u) / parts;
    }
    const float* found = texel(texels, x, 3);
    EXPECT_NEAR(found[0] / found[3], expected, 2e-3) << x;
  }
}

TEST_F(BakeTest, InstancesThatShareATextureAreBakedTogetherAndOthersLeftOut) {
  const scene::Scene scene{{{square({0, 0}, {0.5F, 0.5F}), lambert(0.2)},
                            {square({0, 0}, {1, 1}), lambert(0.4)},
                            {square({0.5F, 0.5F}, {1, 1}), lambert(0.8)}},
                           {light_}};
  const std::vector<float> texels = bake(scene, {{2, 0}});
  EXPECT_FLOAT_EQ(texel(texels, 1, 6)[0], 0.2F);
  EXPECT_FLOAT_EQ(texel(texels, 6, 1)[0], 0.8F);
  EXPECT_EQ(texel(texels, 1, 1)[3], 0.0F);
}

TEST_F(BakeTest, MirroredUvsAreLitAlike) {
  const std::vector<float> texels = bake({{{square({1, 0}, {0, 1}), lambert(0.5)}}, {light_}}, {{0}});
  EXPECT_FLOAT_EQ(texel(texels, 4, 4)[0], 0.5F);
}

TEST_F(BakeTest, ALambertSphereFollowsTheCosineOfTheLight) {
  view_.resize(64, 32);
  const scene::Scene scene{{{std::make_shared<scene::Mesh>(scene::unit_sphere(128, 64)), lambert(1.0)}}, {light_}};
  const std::vector<float> texels = bake(scene, {{0}}, 64);
  for (int y = 1; y < 31; ++y) {
    // The mean of the cosine over a row, which spans pi / 32 of the polar angle and nothing else.
    const double upper = y * pi / 32.0;
    const double lower = std::min((y + 1) * pi / 32.0, pi / 2.0);
    const double expected = lower > upper ? (std::sin(lower) - std::sin(upper)) * 32.0 / pi : 0.0;
    EXPECT_NEAR(texel(texels, 17, y)[0], expected, 1e-3) << y;
  }
}

TEST_F(BakeTest, AGrainAKilometreAwayIsAsExactAsOneAtTheOrigin) {
  scene::Material material;
  material.model = scene::Model::model_2;
  scene::Instance sphere{std::make_shared<scene::Mesh>(scene::unit_sphere(32, 16)), material};
  const std::vector<float> here = bake({{sphere}, {light_}}, {{0}}, 1);
  EXPECT_EQ(view_.timings().front().pass, "light_maps");
  sphere.object_to_world = glm::translate(glm::dmat4(1.0), glm::dvec3(1e6, -2e6, 3e6));  // in millimetres
  const std::vector<float> there = bake({{sphere}, {light_}}, {{0}}, 1);
  for (std::size_t i = 0; i < here.size(); ++i) EXPECT_NEAR(there[i], here[i], 1e-6F);
}

TEST_F(BakeTest, TheViewerIsAboveTheSurfaceOrTheCamera) {
  scene::Material shiny;
  shiny.model = scene::Model::conductor;
  shiny.reflectance = glm::dvec3(1.0);
  shiny.roughness = 0.5;
  light_.direction_to_light = {0, 1, 2};
  const scene::Scene scene{{{square({0, 0}, {1, 1}), shiny}}, {light_}};
  const auto radiance_from = [&](const glm::dvec3& position) {
    view_.set_camera(scene::Camera::look_at(position, {0.5, 0.5, 0}, {0, 0.1, 1}, 45.0));
    return texel(bake(scene, {{0}, ViewFrom::active_camera}), 4, 4)[0];
  };
  const float above = texel(bake(scene, {{0}}), 4, 4)[0];
  EXPECT_NEAR(radiance_from({0.5, 0.5, 1e5}), above, 1e-4F * above);
  // From where the mirror direction is, it is brighter; from the light's side darker.
  EXPECT_GT(radiance_from({0.5, -1e5, 2e5}), 1.2F * above);
  EXPECT_LT(radiance_from({0.5, 1e5, 1e5}), 0.9F * above);
  // From right behind it is seen from right above, and from beside as from a rise of 0.2.
  EXPECT_NEAR(radiance_from({0.5, 0.5, -1e5}), above, 1e-3F * above);
  EXPECT_NEAR(radiance_from({0.5, -1e5, 1e3}), radiance_from({0.5, -1e5, 2.02e4}), 0.02F * above);
}

TEST_F(BakeTest, TheUseOfTheTextureIsCounted) {
  view_.set_scene(
      {{{square({0, 0}, {0.5F, 0.5F}), lambert(0.2)}, {square({0.25F, 0.25F}, {1.5F, 0.5F}), lambert(0.8)}}, {light_}});
  view_.set_bake({{0, 1}});
  const UvUse use = view_.uv_use();
  EXPECT_EQ(use.texels, 16U + 8U);
  EXPECT_EQ(use.overlapping, 4U);
  EXPECT_EQ(use.triangles_outside, 2U);
  ASSERT_EQ(warnings(use).size(), 2U);
  EXPECT_NE(warnings(use)[0].find("UVs overlap in 4 of 24 texels"), std::string::npos);
  EXPECT_NE(warnings(use)[1].find("2 triangles reach out"), std::string::npos);
  view_.set_bake({{0}});
  EXPECT_TRUE(warnings(view_.uv_use()).empty());
}

TEST_F(BakeTest, ANewSceneIsSeenThroughTheCameraAgain) {
  const scene::Scene scene{{{square({0, 0}, {1, 1}), lambert(0.5)}}, {light_}};
  EXPECT_EQ(texel(bake(scene, {{0}}), 0, 0)[3], 1.0F);
  view_.set_camera(scene::Camera::look_at({0.5, 0.5, 40}, {0.5, 0.5, 0}, {0, 1, 0}, 45.0));
  view_.set_scene(scene);
  view_.render(1);
  std::vector<float> pixels(side * side * 4);
  view_.read(pixels.data());
  EXPECT_EQ(texel(pixels, 0, 0)[3], 0.0F);
}

TEST_F(BakeTest, WhatCannotBeBakedIsSaid) {
  view_.set_scene({{{square({0, 0}, {1, 1}, false), lambert(0.5)}}, {light_}});
  expect_error([&] { view_.set_bake({}); }, "at least one instance");
  expect_error([&] { view_.set_bake({{1}}); }, "among the scene's 1, counted from 0; got 1");
  expect_error([&] { view_.set_bake({{0}}); }, "the mesh of instance 0 has none");
  expect_error([&] { view_.uv_use(); }, "set_bake first");
  expect_error([] { warnings({}); }, "the middle of no texel");
  expect_error([] { parse_view_from("below"); }, "above_surface, active_camera; got 'below'");
}

}  // namespace
}  // namespace mesograin::render

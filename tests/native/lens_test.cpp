// A lens keeps what is in focus where it is, and blurs the rest in its own shape, however surfaces are found.
#include "scene/lens.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <memory>
#include <vector>

#include "base/error.h"
#include "gl/context_thread.h"
#include "render/sequence.h"
#include "render/view.h"
#include "scene/camera.h"
#include "scene/sphere.h"

namespace mesograin::scene {
namespace {

std::vector<glm::dvec2> places(const Lens& lens, std::uint32_t count) {
  std::vector<glm::dvec2> found;
  for (std::uint32_t i = 0; i < count; ++i) found.push_back(lens.place(render::scrambled_point(i, 5)));
  return found;
}

glm::dvec2 on_picture(const Camera& camera, const glm::dvec3& place) {
  const glm::dvec4 clip = camera.camera_to_clip * (camera.world_to_camera * glm::dvec4(place, 1.0));
  return glm::dvec2(clip) / clip.w;
}

TEST(Lens, ItsPlacesFillItEvenly) {
  // The second moment of a disc is r^2 / 4 along each axis, that of a regular polygon r^2 (2 + cos(2 pi / n)) / 12.
  for (const int blades : {0, 2, 3, 5, 6}) {
    const double moment = blades < 3 ? 0.25 : (2.0 + std::cos(2.0 * std::acos(-1.0) / blades)) / 12.0;
    glm::dvec2 mean(0.0);
    glm::dvec2 squares(0.0);
    double farthest = 0.0;
    const std::vector<glm::dvec2> all = places({2.0, 1.0, blades, 0.7, 4.0}, 4096);
    for (const glm::dvec2& place : all) {
      const glm::dvec2 round(4.0 * place.x, place.y);
      farthest = std::max(farthest, glm::length(round));
      mean += place / 4096.0;
      squares += round * round / 4096.0;
    }
    EXPECT_NEAR(mean.x, 0.0, 2e-3) << blades;
    EXPECT_NEAR(mean.y, 0.0, 5e-3) << blades;
    EXPECT_NEAR(squares.x, 4.0 * moment, 2e-2) << blades;
    EXPECT_NEAR(squares.y, 4.0 * moment, 2e-2) << blades;
    EXPECT_LE(farthest, 2.0 + 1e-9) << blades;
    EXPECT_GT(farthest, 1.9) << blades;
  }
}

// Alone along one axis, together with time and in the plane: 2^k points fall one into each of 2^k strips and boxes.
TEST(Lens, SamplesAreSpreadOverIt) {
  for (const std::uint32_t seed : {0U, 7U}) {
    std::vector<int> columns(64, 0);
    std::vector<int> rows(64, 0);
    std::vector<int> boxes(64, 0);
    for (std::uint32_t i = 64; i < 128; ++i) {
      const glm::dvec2 point = 64.0 * render::scrambled_point(i, seed);
      const auto x = static_cast<std::size_t>(point.x);
      const auto y = static_cast<std::size_t>(point.y);
      ++columns.at(x);
      ++rows.at(y);
      ++boxes.at(x / 8 * 8 + y / 8);
    }
    EXPECT_EQ(columns, std::vector<int>(64, 1));
    EXPECT_EQ(rows, std::vector<int>(64, 1));
    EXPECT_EQ(boxes, std::vector<int>(64, 1));
  }
}

// What all pixels share of a sky: 16 samples of 4 directions.
TEST(Lens, AFewSamplesHaveTheMeanOfWhatIsSmooth) {
  for (std::uint32_t seed = 0; seed < 16; ++seed) {
    double steep = 0.0;
    double bent = 0.0;
    for (std::uint32_t i = 64; i < 128; ++i) {
      const glm::dvec2 point = render::scrambled_point(i, seed);
      steep += point.y * point.y / 64.0;
      bent += point.x * point.x * point.y / 64.0;
    }
    EXPECT_NEAR(steep, 1.0 / 3.0, 4e-3) << seed;
    EXPECT_NEAR(bent, 1.0 / 6.0, 6e-3) << seed;
  }
}

TEST(Lens, WhatIsInFocusStays) {
  const glm::dmat4 world_to_camera = glm::lookAt(glm::dvec3(1, 2, 5), glm::dvec3(0), glm::dvec3(0, 1, 0));
  const glm::dmat4 camera_to_world = glm::inverse(world_to_camera);
  for (const glm::dmat4& to_clip :
       {glm::perspective(0.8, 1.3, 0.1, 100.0), glm::ortho(-2.0, 2.0, -1.5, 1.5, 0.1, 100.0)}) {
    const Camera camera{world_to_camera, to_clip, Lens{0.3, 4.0}};
    const Camera aside = camera.through({0.2, -0.1});
    EXPECT_FALSE(aside.lens);
    const glm::dvec3 sharp(camera_to_world * glm::dvec4(0.4, -0.3, -4.0, 1.0));
    EXPECT_LT(glm::distance(on_picture(camera, sharp), on_picture(aside, sharp)), 1e-12);
    // What is twice as far moves with the eye by half as much as the eye.
    const glm::dvec3 blurred(camera_to_world * glm::dvec4(0.4, -0.3, -8.0, 1.0));
    const glm::dvec2 moved = on_picture(aside, blurred) - on_picture(camera, blurred);
    const double w = to_clip[2][3] == 0.0 ? 1.0 : 8.0;
    EXPECT_NEAR(moved.x, 0.2 * to_clip[0][0] / w, 1e-12);
    EXPECT_NEAR(moved.y, -0.1 * to_clip[1][1] / w, 1e-12);
  }
}

TEST(Lens, NumbersThatNoLensHasAreRefused) {
  const Camera camera = Camera::look_at({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 45.0);
  for (const Lens& lens : {Lens{-1.0, 1.0}, Lens{NAN, 1.0}, Lens{1.0, 0.0}, Lens{1.0, 1.0, -1},
                           Lens{1.0, 1.0, 0, INFINITY}, Lens{1.0, 1.0, 0, 0.0, 0.0}})
    EXPECT_THROW(validate(Camera{camera.world_to_camera, camera.camera_to_clip, lens}), Error);
}

// Twelve balls near and far, as an array or one by one, in three pictures of 64 x 32.
std::vector<float> picture(bool array, render::Visibility visibility, const Camera& camera) {
  const auto ball = std::make_shared<const Mesh>(unit_sphere(64, 32));
  Material material;
  material.model = Model::lambert;
  DirectionalLight sun;
  sun.direction_to_light = glm::normalize(glm::dvec3(1, 1, 2));
  sun.irradiance = glm::dvec3(3.0);
  std::vector<glm::dmat4> matrices(12);
  for (int i = 0; i < 12; ++i) {
    const int row = i / 4;
    const glm::dvec3 middle(i % 4 - 1.5, row - 1.0, 0.8 * (i % 3) - 2.0);
    matrices[static_cast<std::size_t>(i)] = glm::scale(glm::translate(glm::dmat4(1.0), middle), glm::dvec3(0.5));
  }
  Scene scene{{}, {sun}};
  if (array) {
    scene.arrays.emplace_back(ball, material, scene::Transforms(matrices));
  } else {
    for (const glm::dmat4& matrix : matrices) {
      // Too few of one material to become an array.
      Material own = material;
      own.reflectance = glm::dvec3(0.5 + 1e-9 * static_cast<double>(scene.instances.size()));
      scene.instances.push_back({ball, own, matrix});
    }
  }
  scene.exchange = Exchange::off;
  render::View view(64, 32);
  view.set_visibility(visibility);
  view.set_scene(scene);
  view.set_camera(camera);
  view.render(32);
  std::vector<float> pixels(64UL * 32 * 4);
  view.read(pixels.data());
  EXPECT_TRUE(gl::ContextThread::instance().take_gl_errors().empty());
  return pixels;
}

double apart(const std::vector<float>& a, const std::vector<float>& b) {
  double difference = 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference += std::abs(a[i] - b[i]);
    sum += b[i];
  }
  return difference / sum;
}

TEST(Lens, DrawnCastAndOneByOneAreBlurredAlike) {
  Camera camera = Camera::look_at({0, -1, 6}, {0, 0, 0}, {0, 1, 0}, 30.0, 2.0);
  const std::vector<float> sharp = picture(true, render::Visibility::cast, camera);
  camera.lens = Lens{0.3, 5.0, 5, 0.2, 1.5};
  const std::vector<float> cast = picture(true, render::Visibility::cast, camera);
  EXPECT_GT(apart(sharp, cast), 0.05);
  EXPECT_LT(apart(picture(true, render::Visibility::drawn, camera), cast), 0.01);
  EXPECT_LT(apart(picture(false, render::Visibility::automatic, camera), cast), 0.01);
}

}  // namespace
}  // namespace mesograin::scene

// A view's pictures against what can be computed by hand, and what it sends to the device and when.
#include "render/view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <thread>

#include "expect_error.h"
#include "gl/context_thread.h"
#include "scene/sphere.h"

namespace mesograin::render {
namespace {

using test::expect_error;

constexpr double pi = 3.14159265358979323846;

scene::MeshPointer square(double half = 1.0) {
  const auto h = static_cast<float>(half);
  return std::make_shared<scene::Mesh>(std::vector<glm::vec3>{{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}},
                                       std::vector<glm::vec3>(4, glm::vec3(0, 0, 1)),
                                       std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}});
}

scene::Camera straight_camera() { return scene::Camera::look_at({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 45.0); }

std::vector<float> picture(View& view, int samples = 4) {
  view.render(samples);
  std::vector<float> pixels(static_cast<std::size_t>(view.width()) * static_cast<std::size_t>(view.height()) * 4);
  view.read(pixels.data());
  return pixels;
}

const float* pixel(const std::vector<float>& pixels, int width, int x, int y) {
  return pixels.data() +
         (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) * 4;
}

class ViewTest : public testing::Test {
 protected:
  void TearDown() override { EXPECT_TRUE(gl::ContextThread::instance().take_gl_errors().empty()); }

  scene::Material lambert_;
  scene::Scene one_square_{{{square(), lambert_}}, {scene::DirectionalLight{{0, 0, 1}, {pi, 2 * pi, 3 * pi}}}};
};

TEST_F(ViewTest, LambertSquareHasTheRadianceOfLambertsLaw) {
  View view(32, 32);
  view.set_scene(one_square_);
  view.set_camera(straight_camera());
  const std::vector<float> pixels = picture(view);
  const float* centre = pixel(pixels, 32, 16, 16);
  EXPECT_FLOAT_EQ(centre[0], 0.5F);
  EXPECT_FLOAT_EQ(centre[1], 1.0F);
  EXPECT_FLOAT_EQ(centre[2], 1.5F);
  EXPECT_FLOAT_EQ(centre[3], 1.0F);
  const float* corner = pixel(pixels, 32, 0, 0);
  for (int channel = 0; channel < 4; ++channel) EXPECT_EQ(corner[channel], 0.0F);
}

TEST_F(ViewTest, RowZeroIsTheTop) {
  scene::Scene scene = one_square_;
  scene.instances[0].object_to_world = glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0.7, 0));
  View view(32, 32);
  view.set_scene(scene);
  view.set_camera(straight_camera());
  const std::vector<float> pixels = picture(view);
  EXPECT_EQ(pixel(pixels, 32, 16, 2)[3], 1.0F);
  EXPECT_EQ(pixel(pixels, 32, 16, 29)[3], 0.0F);
}

TEST_F(ViewTest, CoverageOfAnEdgePixelIsItsCoveredArea) {
  // An orthographic picture 4 units wide and 4 pixels wide; the square ends a quarter into a pixel.
  const scene::Camera camera{glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0, -4)),
                             glm::ortho(-2.0, 2.0, -2.0, 2.0, 0.1, 10.0)};
  View view(4, 4);
  scene::Scene scene{{{square(1.25), lambert_}}, {scene::DirectionalLight{{0, 0, 1}, {1, 1, 1}}}};
  view.set_scene(scene);
  view.set_camera(camera);
  const std::vector<float> pixels = picture(view, 1024);
  EXPECT_NEAR(pixel(pixels, 4, 0, 1)[3], 0.25F, 0.005F);
  EXPECT_NEAR(pixel(pixels, 4, 0, 0)[3], 0.0625F, 0.005F);
}

TEST_F(ViewTest, MoreGrainsThanAStencilHoldsKeepTheirOwnMaterials) {
  constexpr int side = 20;
  scene::Scene scene{{}, {scene::DirectionalLight{{0, 0, 1}, {pi, pi, pi}}}};
  for (int i = 0; i < side * side; ++i) {
    const int column = i % side;
    const int row = i / side;
    const glm::dvec3 place(column - 0.5 * (side - 1), 0.5 * (side - 1) - row, 0.0);
    lambert_.reflectance = glm::dvec3((i + 1.0) / (side * side));
    scene.instances.push_back({square(0.5), lambert_, glm::translate(glm::dmat4(1.0), place)});
  }
  View view(side, side);
  view.set_scene(scene);
  view.set_camera({glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0, -4)),
                   glm::ortho(-0.5 * side, 0.5 * side, -0.5 * side, 0.5 * side, 0.1, 10.0)});
  const std::vector<float> pixels = picture(view);
  for (int i = 0; i < side * side; ++i)
    EXPECT_FLOAT_EQ(pixel(pixels, side, i % side, i / side)[0], (i + 1.0F) / (side * side)) << i;
}

TEST_F(ViewTest, ACameraInsideAGrainSeesItEverywhere) {
  View view(16, 16);
  view.set_scene({{{std::make_shared<scene::Mesh>(scene::unit_sphere(64, 32)), lambert_}}, one_square_.lights});
  view.set_camera(scene::Camera::look_at({0, 0, 0.5}, {0, 0, 0}, {0, 1, 0}, 45.0));
  const std::vector<float> pixels = picture(view);
  for (std::size_t i = 3; i < pixels.size(); i += 4) EXPECT_EQ(pixels[i], 1.0F);
}

TEST_F(ViewTest, AGrainAKilometreAwayIsAsExactAsOneAtTheOrigin) {
  const glm::dvec3 far_away(1e6, -2e6, 3e6);  // a kilometre in millimetres
  scene::Scene far_scene = one_square_;
  far_scene.instances[0].object_to_world = glm::translate(glm::dmat4(1.0), far_away);
  scene::Camera far_camera = straight_camera();
  far_camera.world_to_camera = glm::translate(far_camera.world_to_camera, -far_away);
  View here(16, 16);
  here.set_scene(one_square_);
  here.set_camera(straight_camera());
  View there(16, 16);
  there.set_scene(far_scene);
  there.set_camera(far_camera);
  const std::vector<float> expected = picture(here);
  const std::vector<float> found = picture(there);
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-6F);
}

TEST_F(ViewTest, MirroredInstancesFaceTheSameWay) {
  scene::Scene scene = one_square_;
  scene.instances[0].object_to_world = glm::scale(glm::dmat4(1.0), glm::dvec3(-1, 1, 1));
  View view(16, 16);
  view.set_scene(scene);
  view.set_camera(straight_camera());
  EXPECT_FLOAT_EQ(pixel(picture(view), 16, 8, 8)[0], 0.5F);
}

TEST_F(ViewTest, BothSidesOfAnOpenMeshAreLit) {
  scene::Scene scene = one_square_;
  std::get<scene::DirectionalLight>(scene.lights[0]).direction_to_light = {0, 0, -1};
  View view(16, 16);
  view.set_scene(scene);
  view.set_camera(scene::Camera::look_at({0, 0, -4}, {0, 0, 0}, {0, 1, 0}, 45.0));
  EXPECT_FLOAT_EQ(pixel(picture(view), 16, 8, 8)[0], 0.5F);
}

TEST_F(ViewTest, NoLightLeaksOverTheSilhouetteOfAClosedGrain) {
  scene::Scene scene{{{std::make_shared<scene::Mesh>(scene::unit_sphere(64, 32)), lambert_}},
                     {scene::DirectionalLight{{0, 0.3, -1}, {1, 1, 1}}}};
  View view(128, 128);
  view.set_scene(scene);
  view.set_camera(straight_camera());
  const std::vector<float> pixels = picture(view, 16);
  for (int y = 72; y < 128; ++y)
    for (int x = 0; x < 128; ++x) EXPECT_EQ(pixel(pixels, 128, x, y)[0], 0.0F) << x << ", " << y;
}

TEST_F(ViewTest, LightsAddUpAndNoneIsBlack) {
  scene::Scene scene = one_square_;
  scene.lights.push_back(scene.lights[0]);
  View view(16, 16);
  view.set_scene(scene);
  view.set_camera(straight_camera());
  EXPECT_FLOAT_EQ(pixel(picture(view), 16, 8, 8)[0], 1.0F);
  scene.lights.clear();
  view.set_scene(scene);
  const std::vector<float> dark = picture(view);
  EXPECT_EQ(pixel(dark, 16, 8, 8)[0], 0.0F);
  EXPECT_EQ(pixel(dark, 16, 8, 8)[3], 1.0F);
}

TEST_F(ViewTest, AWorldLightsEveryModel) {
  scene::World grey;
  grey.radiance = glm::dvec3(0.5);
  const auto sphere = std::make_shared<scene::Mesh>(scene::unit_sphere(24, 12));
  View view(16, 16, 0, /*patient=*/false);
  view.set_camera(straight_camera());
  for (std::size_t model = 0; model < scene::model_names.size(); ++model) {
    scene::Material material;
    material.model = static_cast<scene::Model>(model);
    view.set_scene({{{sphere, material}}, {}, grey});
    EXPECT_GT(pixel(picture(view), 16, 8, 8)[0], 0.0F) << scene::model_names[model];
  }
}

TEST_F(ViewTest, AWideSunGivesTheMeanCosineOverItsDisc) {
  scene::Scene scene = one_square_;
  const double angle = 1.0;
  std::get<scene::DirectionalLight>(scene.lights[0]).angle = angle;
  View view(8, 8);
  view.set_scene(scene);
  view.set_camera(straight_camera());
  // The mean of cos over a cone of half-angle a is (1 + cos a) / 2.
  EXPECT_NEAR(pixel(picture(view, 512), 8, 4, 4)[0], 0.5 * (1.0 + std::cos(angle / 2.0)) / 2.0, 1e-3);
}

TEST_F(ViewTest, CameraMotionSendsNothing) {
  View view(16, 16);
  view.set_scene(one_square_);
  view.set_camera(straight_camera());
  view.render(1);
  const Sent before = View::sent();
  view.set_camera(scene::Camera::look_at({1, 1, 4}, {0, 0, 0}, {0, 1, 0}, 45.0));
  EXPECT_EQ(view.samples(), 0);
  view.render(1);
  const Sent after = View::sent();
  EXPECT_EQ(after.bytes, before.bytes);
  EXPECT_EQ(after.meshes, before.meshes);
  EXPECT_EQ(after.materials, before.materials);
  EXPECT_EQ(after.programs, before.programs);
}

TEST_F(ViewTest, AnUnchangedMeshIsNotSentAgainWithAChangedMaterial) {
  View view(16, 16);
  view.set_scene(one_square_);
  const Sent before = View::sent();
  one_square_.instances[0].material.reflectance = glm::dvec3(0.25);
  view.set_scene(one_square_);
  EXPECT_EQ(View::sent().meshes, before.meshes);
  EXPECT_EQ(View::sent().materials, before.materials + 1);
}

TEST_F(ViewTest, TheSameSeedGivesTheSamePictureBitForBit) {
  View first(24, 24, 7);
  View second(24, 24, 7);
  for (View* view : {&first, &second}) {
    view->set_scene(one_square_);
    view->set_camera(scene::Camera::look_at({0.3, 0.2, 4}, {0, 0, 0}, {0, 1, 0}, 45.0));
  }
  EXPECT_EQ(picture(first), picture(second));
}

TEST_F(ViewTest, ResizeKeepsTheSceneAndRestarts) {
  View view(16, 16);
  view.set_scene(one_square_);
  view.set_camera(straight_camera());
  view.render(2);
  const Sent before = View::sent();
  view.resize(20, 12);
  EXPECT_EQ(view.samples(), 0);
  EXPECT_EQ(View::sent().bytes, before.bytes);
  view.set_camera(scene::Camera::look_at({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 45.0, 20.0 / 12.0));
  EXPECT_FLOAT_EQ(pixel(picture(view), 20, 10, 6)[0], 0.5F);
}

TEST_F(ViewTest, CancelEndsARenderEarly) {
  View view(256, 256);
  view.set_scene(one_square_);
  view.set_camera(straight_camera());
  const std::shared_future<double> done = view.start(1'000'000);
  while (view.samples() == 0) std::this_thread::yield();
  view.cancel();
  done.get();
  EXPECT_GE(view.samples(), 1);
  EXPECT_LT(view.samples(), 1'000'000);
}

TEST_F(ViewTest, ReadingWaitsForTheSampleUnderWayAndNotForAll) {
  View drawing(64, 64);
  View beside(64, 64);
  for (View* view : {&drawing, &beside}) {
    view->set_scene(one_square_);
    view->set_camera(straight_camera());
  }
  const std::shared_future<double> done = drawing.start(1'000'000);
  while (drawing.samples() == 0) std::this_thread::yield();
  EXPECT_EQ(pixel(picture(beside, 2), 64, 32, 32)[3], 1.0F);
  std::vector<float> pixels(std::size_t{64} * 64 * 4);
  drawing.read(pixels.data());
  EXPECT_FLOAT_EQ(pixel(pixels, 64, 32, 32)[0], 0.5F);
  EXPECT_FALSE(drawing.timings().empty());
  EXPECT_EQ(drawing.statistics().instances, 0U);
  const auto told = std::make_shared<Picture>();
  drawing.start_read(told).get();
  EXPECT_EQ(told->timings.size(), 2U);
  EXPECT_FLOAT_EQ(pixel(told->pixels, 64, 32, 32)[0], 0.5F);
  EXPECT_NE(done.wait_for(std::chrono::seconds(0)), std::future_status::ready);
  drawing.cancel();
  EXPECT_GT(done.get(), 0.0);
}

TEST_F(ViewTest, ReadingGoesBeforeTheSamplesOfOthers) {
  std::vector<std::unique_ptr<View>> views;
  std::vector<std::shared_future<double>> done;
  for (int i = 0; i < 8; ++i) {
    views.push_back(std::make_unique<View>(64, 64));
    views.back()->set_scene(one_square_);
    views.back()->set_camera(straight_camera());
    done.push_back(views.back()->start(1'000'000));
  }
  while (views.back()->samples() == 0) std::this_thread::yield();
  const auto samples = [&] {
    int sum = 0;
    for (const auto& view : views) sum += view->samples();
    return sum;
  };
  std::vector<float> pixels(std::size_t{64} * 64 * 4);
  constexpr int readings = 20;
  const int before = samples();
  for (int i = 0; i < readings; ++i) views[0]->read(pixels.data());
  EXPECT_LE(samples() - before, 3 * readings);  // where it waited its turn, 8 * readings
  for (const auto& view : views) view->cancel();
}

TEST_F(ViewTest, WhatComesBetweenSamplesLeavesThePictureAsItIsBitForBit) {
  const scene::Scene sphere{{{std::make_shared<scene::Mesh>(scene::unit_sphere(24, 12)), lambert_}},
                            {scene::DirectionalLight{{0.3, 0.4, 1}, {pi, 2 * pi, 3 * pi}, 0.5}}};
  View alone(24, 24, 7);
  View disturbed(24, 24, 7);
  View other(16, 16, 3);
  for (View* view : {&alone, &disturbed}) {
    view->set_scene(sphere);
    view->set_camera(scene::Camera::look_at({0.3, 0.2, 4}, {0, 0, 0}, {0, 1, 0}, 45.0));
  }
  other.set_scene(one_square_);
  other.set_camera(straight_camera());
  const std::vector<float> expected = picture(alone, 200);
  std::vector<float> found(expected.size());
  const std::shared_future<double> done = disturbed.start(200);
  int between = 0;
  for (; done.wait_for(std::chrono::seconds(0)) != std::future_status::ready; ++between) {
    disturbed.read(found.data());
    picture(other, 1);
  }
  EXPECT_GT(between, 2);
  EXPECT_EQ(disturbed.samples(), 200);
  disturbed.read(found.data());
  EXPECT_EQ(found, expected);
}

TEST_F(ViewTest, AChangeComesAfterTheSamplesThatWereAskedForBefore) {
  View view(32, 32);
  view.set_scene(one_square_);
  view.set_camera(straight_camera());
  const std::shared_future<double> first = view.start(20);
  const std::shared_future<double> second = view.start(30);
  view.set_camera(scene::Camera::look_at({0, 0, -4}, {0, 0, 0}, {0, 1, 0}, 45.0));
  EXPECT_EQ(first.wait_for(std::chrono::seconds(0)), std::future_status::ready);
  EXPECT_EQ(second.wait_for(std::chrono::seconds(0)), std::future_status::ready);
  EXPECT_EQ(view.samples(), 0);
  EXPECT_EQ(pixel(picture(view), 32, 16, 16)[0], 0.0F);  // a sample of before would have left light
  EXPECT_EQ(view.samples(), 4);
}

TEST_F(ViewTest, ACancelEndsAllThatWasStartedBeforeItAndNothingAfter) {
  View view(64, 64);
  view.set_scene(one_square_);
  view.set_camera(straight_camera());
  const std::shared_future<double> first = view.start(1'000'000);
  const std::shared_future<double> second = view.start(1'000'000);
  view.cancel();
  const std::shared_future<double> third = view.start(3);
  third.wait();
  EXPECT_EQ(first.wait_for(std::chrono::seconds(0)), std::future_status::ready);
  EXPECT_EQ(second.wait_for(std::chrono::seconds(0)), std::future_status::ready);
  EXPECT_GE(view.samples(), 3);
  EXPECT_LE(view.samples(), 5);
}

TEST_F(ViewTest, ShuttingDownEndsSamplesUnderWayWithAnError) {
  View view(64, 64);
  view.set_scene(one_square_);
  view.set_camera(straight_camera());
  const std::shared_future<double> done = view.start(1'000'000);
  while (view.samples() == 0) std::this_thread::yield();
  gl::ContextThread::shut_down();
  EXPECT_LT(view.samples(), 1'000'000);
  expect_error([&] { done.get(); }, "has been shut down");
  expect_error([&] { view.render(1); }, "make a new one");
}

TEST_F(ViewTest, TimingsNameThePassesThatRan) {
  View view(16, 16);
  EXPECT_TRUE(view.timings().empty());
  view.set_scene(one_square_);
  view.set_camera(straight_camera());
  view.render(1);
  const std::vector<PassTiming> timings = view.timings();
  ASSERT_EQ(timings.size(), 2U);
  EXPECT_EQ(timings[0].pass, "shade");
  EXPECT_EQ(timings[1].pass, "accumulate");
  for (const PassTiming& timing : timings) EXPECT_GT(timing.milliseconds, 0.0);
}

TEST_F(ViewTest, WhatCannotBeDrawnIsRefusedAndChangesNothing) {
  View view(16, 16);
  view.set_scene(one_square_);
  view.set_camera(straight_camera());
  scene::Scene broken = one_square_;
  broken.instances[0].material.reflectance.g = std::numeric_limits<double>::quiet_NaN();
  expect_error([&] { view.set_scene(broken); }, "reflectance (channel G)");
  broken = one_square_;
  broken.instances[0].object_to_world = glm::dmat4(0.0);
  expect_error([&] { view.set_scene(broken); }, "invertible");
  broken = one_square_;
  std::get<scene::DirectionalLight>(broken.lights[0]).direction_to_light = glm::dvec3(0.0);
  expect_error([&] { view.set_scene(broken); }, "direction_to_light");
  scene::Camera camera = straight_camera();
  camera.camera_to_clip[1][1] = std::numeric_limits<double>::infinity();
  expect_error([&] { view.set_camera(camera); }, "camera_to_clip");
  expect_error([&] { view.render(0); }, "at least one sample");
  expect_error([&] { view.resize(0, 5); }, "between 1 and");
  expect_error([&] { view.resize(1 << 20, 5); }, "between 1 and");
  EXPECT_FLOAT_EQ(pixel(picture(view), 16, 8, 8)[0], 0.5F);
}

TEST_F(ViewTest, WhatOnlyStartsDoesNotWaitForAThreadThatIsBusy) {
  View drawn(16, 16, 0, false);
  drawn.set_scene(one_square_);
  drawn.set_camera(straight_camera());
  drawn.render(1);
  std::promise<void> open;
  const auto held = gl::ContextThread::instance().post([&] { open.get_future().wait(); });
  // Would hang here for ever if one of these waited.
  auto made = std::make_unique<View>(16, 16, 0, false);
  const auto picture = std::make_shared<Picture>();
  const auto earlier = std::make_shared<Picture>();
  const auto early = drawn.start_read(earlier);
  const auto taking = made->start_scene(one_square_);
  const auto moving = drawn.start_camera(straight_camera(), 8, 4);
  const auto samples = drawn.start(2, picture);
  auto ended = std::make_unique<View>(16, 16, 0, false);
  ended->start_scene(one_square_);
  ended.reset();
  EXPECT_EQ(drawn.preparing(), std::nullopt);
  drawn.cancel();
  const auto again = std::make_shared<Picture>();
  const auto more = drawn.start(2, again);
  EXPECT_NE(samples.wait_for(std::chrono::seconds(0)), std::future_status::ready);
  open.set_value();
  taking.get();
  moving.get();
  early.get();
  samples.get();
  more.get();
  EXPECT_TRUE(picture->pixels.empty()) << "these were cancelled";
  EXPECT_EQ(earlier->width, 16);
  ASSERT_EQ(again->width * again->height, 32);
  EXPECT_EQ(drawn.width(), 8);
  EXPECT_EQ(drawn.samples(), 2);
  std::vector<float> read(8 * 4 * 4);
  drawn.read(read.data());
  EXPECT_EQ(again->pixels, read);
  EXPECT_FLOAT_EQ(pixel(read, 8, 4, 2)[0], 0.5F);
}

TEST_F(ViewTest, WhatKeepsAViewFromBeingMadeIsSaidByTheFirstCallThatWaits) {
  View view(1 << 20, 1 << 20);
  expect_error([&] { view.set_scene(one_square_); }, "1048576");
  expect_error([&] { view.render(1); }, "1048576");
}

}  // namespace
}  // namespace mesograin::render

// Arrays of instances against the same instances drawn one by one, and the shadows that objects cast on each other
// against geometry.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>
#include <utility>

#include "expect_error.h"
#include "gl/context_thread.h"
#include "render/view.h"
#include "scene/convexity.h"
#include "scene/sphere.h"

namespace mesograin::render {
namespace {

constexpr double pi = 3.14159265358979323846;

// Closed, smooth and hollow in places.
scene::MeshPointer bumpy(int segments = 64, int rings = 32) {
  const scene::Mesh sphere = scene::unit_sphere(segments, rings);
  std::vector<glm::vec3> positions = sphere.positions();
  for (glm::vec3& p : positions) p *= 1.0F + 0.15F * std::sin(4.0F * p.x + 1.0F) * std::cos(5.0F * p.y - 3.0F * p.z);
  return std::make_shared<scene::Mesh>(positions, std::vector<glm::vec3>(), sphere.triangles());
}

// For light maps: Mesa 22 reallocates the vertices of a tessellated mesh with every patch, which the address sanitizer
// makes a copy of all.
scene::MeshPointer few_triangles() { return bumpy(32, 16); }

scene::MeshPointer square(float half) {
  return std::make_shared<scene::Mesh>(
      std::vector<glm::vec3>{{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}},
      std::vector<glm::vec3>(4, glm::vec3(0, 0, 1)), std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}});
}

scene::Light sun(const glm::dvec3& to_light, double irradiance) {
  return scene::DirectionalLight{to_light, glm::dvec3(irradiance)};
}

scene::Scene array_of(const scene::MeshPointer& mesh, const scene::Material& material, std::vector<glm::dmat4> places,
                      std::vector<scene::Light> lights) {
  scene::Scene scene;
  scene.lights = std::move(lights);
  scene.arrays.emplace_back(mesh, material, scene::Transforms(places));
  // So that an array can be held against grains one by one.
  scene.exchange = scene::Exchange::off;
  return scene;
}

// Turned at random, of sizes between 0.7 and 1.3, on a grid of 4 x 2.
std::vector<glm::dmat4> eight_places() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<glm::dmat4> places;
  for (int i = 0; i < 8; ++i) {
    const int row = i / 4;
    glm::dmat4 place = glm::translate(glm::dmat4(1.0), glm::dvec3(3.0 * (i % 4) - 4.5, 3.0 * row - 1.5, 0.0));
    const glm::dvec3 axis(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5);
    place = glm::rotate(place, 2.0 * pi * unit(random), glm::normalize(axis));
    places.push_back(glm::scale(place, glm::dvec3(0.7 + 0.6 * unit(random))));
  }
  return places;
}

std::vector<float> picture(View& view, int samples, Visibility visibility) {
  view.set_visibility(visibility);
  view.render(samples);
  std::vector<float> pixels(static_cast<std::size_t>(view.width()) * static_cast<std::size_t>(view.height()) * 4);
  view.read(pixels.data());
  return pixels;
}

std::vector<float> picture(const scene::Scene& scene, const scene::Camera& camera, int width, int height, int samples,
                           Visibility visibility = Visibility::automatic) {
  View view(width, height);
  view.set_scene(scene);
  view.set_camera(camera);
  return picture(view, samples, visibility);
}

struct Difference {
  double blocks = 0.0;  // relative L1 of blocks of 8 x 8 pixels
  double total = 0.0;   // ratio
};

Difference difference(const std::vector<float>& image, const std::vector<float>& reference, int width, int height) {
  Difference result;
  double sum = 0.0;
  double reference_sum = 0.0;
  for (int y = 0; y < height; y += 8)
    for (int x = 0; x < width; x += 8)
      for (std::size_t channel = 0; channel < 3; ++channel) {
        double block = 0.0;
        double reference_block = 0.0;
        for (int row = y; row < y + 8; ++row)
          for (int column = x; column < x + 8; ++column) {
            const auto pixel = static_cast<std::size_t>(row * width + column) * 4 + channel;
            block += image[pixel];
            reference_block += reference[pixel];
          }
        result.blocks += std::abs(block - reference_block);
        sum += block;
        reference_sum += reference_block;
      }
  result.blocks /= reference_sum;
  result.total = sum / reference_sum;
  return result;
}

class HeapTest : public testing::Test {
 protected:
  void TearDown() override { EXPECT_TRUE(gl::ContextThread::instance().take_gl_errors().empty()); }
};

void expect_array_as_one_by_one(const scene::MeshPointer& mesh, scene::Model model, double most_in_blocks,
                                Visibility visibility) {
  scene::Material material;
  material.model = model;
  material.sigma_a = {0.05, 0.2, 0.6};
  material.sigma_s = glm::dvec3(2.0);
  material.roughness = 0.3;
  const std::vector<scene::Light> lights = {sun({1.0, 0.3, 0.6}, 3.0), sun({-1.0, 0.3, -1.0}, 1.0)};
  scene::Scene one_by_one{{}, lights};
  one_by_one.exchange = scene::Exchange::off;
  for (const glm::dmat4& place : eight_places()) one_by_one.instances.push_back({mesh, material, place});
  const scene::Scene array = array_of(mesh, material, eight_places(), lights);
  const scene::Camera camera = scene::Camera::look_at({0, 0, 16}, {0, 0, 0}, {0, 1, 0}, 30.0, 2.0);
  const Difference found =
      difference(picture(array, camera, 256, 128, 12, visibility), picture(one_by_one, camera, 256, 128, 12), 256, 128);
  EXPECT_LT(found.blocks, most_in_blocks);
  EXPECT_NEAR(found.total, 1.0, 0.01);
}

TEST_F(HeapTest, AnArrayOfOpaqueGrainsIsAsOneByOne) {
  for (const Visibility visibility : {Visibility::drawn, Visibility::cast}) {
    expect_array_as_one_by_one(bumpy(), scene::Model::lambert, 0.01, visibility);
    expect_array_as_one_by_one(bumpy(), scene::Model::model_1, 0.012, visibility);
  }
}

#if defined(__SANITIZE_ADDRESS__)
// What the device draws is not instrumented, and the same code sends it to each model's program.
const std::vector<scene::Model> translucent = {scene::Model::model_3};
#else
const std::vector<scene::Model> translucent = {scene::Model::model_2, scene::Model::model_3};
#endif

// Their light maps are from directions near the light's.
TEST_F(HeapTest, AnArrayOfTranslucentGrainsIsNearlyAsOneByOne) {
  for (const Visibility visibility : {Visibility::drawn, Visibility::cast})
    for (const scene::Model model : translucent) expect_array_as_one_by_one(few_triangles(), model, 0.035, visibility);
}

// Grains on a ground, some mirrored, close enough to shade each other; a lamp and a sun.
scene::Scene small_heap(const scene::MeshPointer& mesh, scene::Model model) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<glm::dmat4> places;
  for (int i = 0; i < 60; ++i) {
    const glm::dvec3 place(9.0 * unit(random) - 4.5, 6.0 * unit(random) - 3.0, 1.0 + 2.0 * unit(random));
    const glm::dvec3 axis(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5);
    glm::dmat4 matrix = glm::rotate(glm::translate(glm::dmat4(1.0), place), 2.0 * pi * unit(random), axis);
    matrix = glm::scale(matrix, (0.5 + 0.4 * unit(random)) * glm::dvec3(i % 2 == 0 ? 1.0 : -1.0, 1.0, 0.8));
    places.push_back(matrix);
  }
  scene::Material material;
  material.model = model;
  material.specular = false;  // grains mirror each other where rays are cast alone
  scene::PointLight lamp;
  lamp.position = {-5.0, 4.0, 9.0};
  lamp.radiant_intensity = glm::dvec3(150.0);
  lamp.radius = 0.3;
  scene::Scene scene = array_of(mesh, material, places, {sun({1.0, 0.3, 1.0}, 3.0), lamp});
  scene.instances.push_back({square(20.0F), {}, glm::dmat4(1.0)});
  return scene;
}

TEST_F(HeapTest, WhatIsCastIsWhatIsDrawn) {
  const scene::Camera camera = scene::Camera::look_at({0, -9, 16}, {0, 0, 0}, {0, 1, 0}, 35.0, 2.0);
  const auto ball = std::make_shared<scene::Mesh>(scene::unit_sphere(48, 24));
  const auto found = [&](const scene::MeshPointer& mesh, scene::Model model) {
    const scene::Scene scene = small_heap(mesh, model);
    return difference(picture(scene, camera, 256, 128, 4, Visibility::cast),
                      picture(scene, camera, 256, 128, 4, Visibility::drawn), 256, 128);
  };
  // Rays to the lights from each pixel; a shadow map tells of a hollow grain's own shadow as finely as its texels are.
  for (const scene::Model model : {scene::Model::lambert, scene::Model::model_1}) {
    const Difference of_balls = found(ball, model);
    EXPECT_LT(of_balls.blocks, 0.005);
    EXPECT_NEAR(of_balls.total, 1.0, 0.002);
    const Difference of_hollows = found(bumpy(), model);
    EXPECT_LT(of_hollows.blocks, 0.01);
    EXPECT_NEAR(of_hollows.total, 1.0, 0.004);
  }
  // Rays from the lights.
  const Difference of_translucent = found(few_triangles(), scene::Model::model_2);
  EXPECT_LT(of_translucent.blocks, 0.005);
  EXPECT_NEAR(of_translucent.total, 1.0, 0.002);
}

// On a surface that wears a picture, too.
TEST_F(HeapTest, WhatTheDevicesRaysFindIsWhatIsDrawn) {
  const scene::Camera camera = scene::Camera::look_at({0, -9, 16}, {0, 0, 0}, {0, 1, 0}, 35.0, 2.0);
  const auto expect_same = [&](const scene::Scene& scene, double most_in_blocks) {
    const Difference found = difference(picture(scene, camera, 128, 64, 4, Visibility::device_rays),
                                        picture(scene, camera, 128, 64, 4, Visibility::drawn), 128, 64);
    EXPECT_LT(found.blocks, most_in_blocks);
    EXPECT_NEAR(found.total, 1.0, 0.004);
  };
  // As of what is cast.
  const auto ball = std::make_shared<scene::Mesh>(scene::unit_sphere(48, 24));
  expect_same(small_heap(ball, scene::Model::lambert), 0.01);
  expect_same(small_heap(bumpy(), scene::Model::model_1), 0.015);
  expect_same(small_heap(few_triangles(), scene::Model::model_2), 0.005);

  std::vector<glm::vec2> uvs;
  for (const glm::vec3& position : ball->positions()) uvs.emplace_back(0.5F * position.x, 0.7F * position.z);
  scene::Scene worn = small_heap(
      std::make_shared<scene::Mesh>(ball->positions(), ball->normals(), ball->triangles(), uvs), scene::Model::lambert);
  const std::vector<glm::u8vec4> texels = {{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}, {255, 255, 255, 255}};
  worn.arrays.front().material.finish.emplace();
  worn.arrays.front().material.finish->reflectance.picture =
      std::make_shared<const scene::Picture>(2, 2, scene::Picture::Bytes(texels.begin(), texels.end()), true);
  expect_same(worn, 0.01);
}

// Metal mirrors its neighbours, which rays on this side find.
TEST_F(HeapTest, WhatADeviceDrawsInAHurryGoesWithTheNextSample) {
  const scene::Camera camera = scene::Camera::look_at({0, -9, 16}, {0, 0, 0}, {0, 1, 0}, 35.0, 2.0);
  const scene::Scene scene =
      small_heap(std::make_shared<scene::Mesh>(scene::unit_sphere(24, 12)), scene::Model::conductor);
  constexpr int width = 64, height = 32;
  const auto pictures = [&](Visibility visibility, const std::vector<int>& steps) {
    View view(width, height, 0, false);
    view.set_visibility(visibility);
    view.set_scene(scene);
    view.set_camera(camera);
    std::vector<std::vector<float>> pictures;
    for (const int samples : steps) {
      view.render(samples);
      pictures.emplace_back(static_cast<std::size_t>(width) * height * 4);
      view.read(pictures.back().data());
    }
    return std::pair(pictures, view.samples());
  };
  const auto [stepwise, after_steps] = pictures(Visibility::device_rays, {1, 1, 1, 30});
  EXPECT_EQ(after_steps, 32);
  const auto [at_once, after_all] = pictures(Visibility::device_rays, {2, 30});
  EXPECT_EQ(after_all, 32);
  EXPECT_EQ(stepwise[2], at_once[0]);
  EXPECT_EQ(stepwise[3], at_once[1]);
  EXPECT_NE(stepwise[0], stepwise[1]);
  const auto [cast, after_cast] = pictures(Visibility::cast, {1, 1, 30});
  EXPECT_EQ(after_cast, 32);
  EXPECT_LT(difference(at_once[1], cast[2], width, height).blocks, 1e-3);
}

// What crosses single grains is followed from what the device's rays have found.
TEST_F(HeapTest, WhatIsGatheredOfGrainsIsTheSameFromTheDevicesRays) {
  const scene::Camera camera = scene::Camera::look_at({0, -9, 16}, {0, 0, 0}, {0, 1, 0}, 35.0, 2.0);
  for (const scene::Boundary boundary : {scene::Boundary::index_matched, scene::Boundary::dielectric}) {
    scene::Scene scene = small_heap(few_triangles(), scene::Model::model_2);
    scene.arrays.front().material.boundary = boundary;
    scene.exchange = scene::Exchange::heaps;
    View view(64, 32);  // in which the light between grains is solved once
    view.set_scene(scene);
    view.set_camera(camera);
    EXPECT_LT(difference(picture(view, 4, Visibility::device_rays), picture(view, 4, Visibility::cast), 64, 32).blocks,
              1e-3);
  }
}

// More groups than the stencil tells apart.
TEST_F(HeapTest, ManyCastMaterialsAreEachShadedWithTheirOwn) {
  const auto ball = std::make_shared<scene::Mesh>(scene::unit_sphere(16, 8));
  scene::Scene scene{{}, {sun({0.0, 0.0, 1.0}, pi)}};
  constexpr int side = 18;
  for (int i = 0; i < side * side; ++i) {
    scene::Material material;
    material.reflectance = glm::dvec3(0.2 + 0.6 * i / (side * side), 0.5, 0.8 - 0.6 * i / (side * side));
    const glm::dmat4 place = glm::translate(glm::dmat4(1.0), glm::dvec3(i % side, i / side, 0.0));
    const glm::dmat4 placed = glm::scale(place, glm::dvec3(0.45));
    scene.arrays.emplace_back(ball, material, scene::Transforms({&placed, 1}));
  }
  scene.exchange = scene::Exchange::off;
  const scene::Camera camera{glm::translate(glm::dmat4(1.0), glm::dvec3(0.5 - side / 2.0, 0.5 - side / 2.0, -5.0)),
                             glm::ortho(-side / 2.0, side / 2.0, -side / 2.0, side / 2.0, 0.1, 20.0)};
  constexpr int size = side * 5;
  for (const Visibility visibility : {Visibility::cast, Visibility::device_rays}) {
    const std::vector<float> pixels = picture(scene, camera, size, size, 1, visibility);
    for (int i = 0; i < side * side; ++i) {
      const auto x = static_cast<std::size_t>(i % side * 5 + 2);
      const auto y = static_cast<std::size_t>(size - 1 - (i / side * 5 + 2));
      const float* pixel = &pixels[4 * (y * static_cast<std::size_t>(size) + x)];
      const double expected = (0.2 + 0.6 * i / (side * side)) / 0.5;
      EXPECT_NEAR(pixel[0] / pixel[1], expected, 1e-4) << i;
    }
  }
}

TEST_F(HeapTest, ManyEqualInstancesAreAnArrayAndLookAlike) {
  scene::Scene scene{{}, {sun({1.0, 0.3, 1.0}, 3.0)}};
  const scene::MeshPointer mesh = bumpy();
  std::vector<glm::dmat4> places = eight_places();
  places.push_back(glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 4.0, 0.0)));
  for (const glm::dmat4& place : places) scene.instances.push_back({mesh, {}, place});
  scene::Scene array = array_of(mesh, {}, places, scene.lights);
  array.exchange = scene.exchange;
  const scene::Camera camera = scene::Camera::look_at({0, 0, 16}, {0, 0, 0}, {0, 1, 0}, 30.0, 2.0);
  EXPECT_EQ(picture(scene, camera, 128, 64, 2), picture(array, camera, 128, 64, 2));
}

TEST_F(HeapTest, AMirroredInstanceOfAnArrayIsSeenFromOutside) {
  const scene::MeshPointer mesh = bumpy();
  const std::vector<scene::Light> lights = {sun({0.3, 0.2, 1.0}, 3.0)};
  const glm::dmat4 mirrored = glm::scale(glm::dmat4(1.0), glm::dvec3(-1.0, 1.0, 1.0));
  const scene::Camera camera = scene::Camera::look_at({0, 0, 8}, {0, 0, 0}, {0, 1, 0}, 20.0);
  const scene::Scene alone{{{mesh, {}, mirrored}}, lights};
  const scene::Scene array = array_of(mesh, {}, {mirrored}, lights);
  const Difference found = difference(picture(array, camera, 64, 64, 32), picture(alone, camera, 64, 64, 32), 64, 64);
  EXPECT_LT(found.blocks, 0.01);
}

// A ball of radius 1 high over a plane, light and view straight down but for the ball being out of the view's way.
TEST_F(HeapTest, AShadowHasTheSizeAndPlaceOfItsObject) {
  const auto ball = std::make_shared<scene::Mesh>(scene::unit_sphere(128, 64));
  scene::Material material;
  material.reflectance = glm::dvec3(1.0);
  const glm::dvec3 to_light = glm::normalize(glm::dvec3(1.0, 0.0, 1.0));
  for (const bool translucent : {false, true}) {
    scene::Material of_ball = material;
    if (translucent) of_ball.model = scene::Model::model_2;
    scene::Scene scene{{{square(20.0F), material, glm::dmat4(1.0)},
                        {ball, of_ball, glm::translate(glm::dmat4(1.0), glm::dvec3(8.0, 0.0, 8.0))}},
                       {sun(to_light, pi)}};
    scene.exchange = scene::Exchange::off;  // what crosses the ball would lighten its shadow
    // Looks at the plane's middle, where the shadow falls: an ellipse of half axes sqrt(2) and 1.
    const scene::Camera camera{glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0, -4)),
                               glm::ortho(-2.0, 2.0, -2.0, 2.0, 0.1, 20.0)};
    constexpr int size = 64;
    const std::vector<float> pixels = picture(scene, camera, size, size, 64);
    const double lit = std::sqrt(0.5);
    double dark = 0.0;
    for (std::size_t i = 0; i < pixels.size(); i += 4) dark += 1.0 - pixels[i] / lit;
    EXPECT_NEAR(dark * 16.0 / (size * size), pi * std::sqrt(2.0), 0.05) << "translucent " << translucent;
    EXPECT_NEAR(pixels[4 * (size / 2 * size + size / 2)], 0.0, 1e-6);
    EXPECT_NEAR(pixels[0], lit, 1e-5);
  }
}

// A lamp over a ball: the shadow on the floor is the ball's, seen from the lamp.
TEST_F(HeapTest, AShadowOfALampWidensWithTheDistance) {
  const auto ball = std::make_shared<scene::Mesh>(scene::unit_sphere(128, 64));
  scene::Material material;
  material.reflectance = glm::dvec3(1.0);
  scene::PointLight lamp;
  lamp.position = {4.0, 0.0, 8.0};
  lamp.radiant_intensity = glm::dvec3(100.0);
  lamp.radius = 0.0;
  // The ball on the lamp's way to the origin, a third of it away from the lamp.
  const glm::dvec3 place = lamp.position * (2.0 / 3.0);
  const double distance = glm::length(lamp.position - place);
  const scene::Camera camera{glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0, -2)),
                             glm::ortho(-8.0, 8.0, -8.0, 8.0, 0.1, 20.0)};
  constexpr int size = 64;
  const scene::Scene open{{{square(20.0F), material, glm::dmat4(1.0)}}, {lamp}};
  scene::Scene shaded = open;
  shaded.instances.push_back({ball, material, glm::translate(glm::dmat4(1.0), place)});
  const std::vector<float> without = picture(open, camera, size, size, 32);
  const std::vector<float> with = picture(shaded, camera, size, size, 32);
  double dark = 0.0;
  for (std::size_t i = 0; i < with.size(); i += 4) dark += 1.0 - with[i] / without[i];
  // A cone of half angle alpha whose axis leans by theta cuts the floor in an ellipse of this area.
  const double leaning = lamp.position.z / glm::length(lamp.position);
  const double sine_squared = 1.0 / (distance * distance);
  const double area = pi * lamp.position.z * lamp.position.z * sine_squared * std::sqrt(1.0 - sine_squared) /
                      std::pow(leaning * leaning - sine_squared, 1.5);
  EXPECT_NEAR(dark * 256.0 / (size * size), area, 0.03 * area);
}

// Where spheres touch, neither shades itself: one under a light that no other stands in is as it is alone.
TEST_F(HeapTest, GrainsThatTouchDoNotShadeThemselves) {
  const auto ball = std::make_shared<scene::Mesh>(scene::unit_sphere(128, 64));
  const std::vector<scene::Light> lights = {sun({0.0, 0.0, 1.0}, 3.0)};
  const scene::Camera camera{glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0, -8)),
                             glm::ortho(-1.0, 1.0, -1.0, 1.0, 0.1, 20.0)};
  const glm::dmat4 here(1.0);
  const glm::dmat4 beside = glm::translate(here, glm::dvec3(2.0, 0.0, 0.0));
  const glm::dmat4 below = glm::translate(here, glm::dvec3(0.0, 0.0, -2.0));
  for (const scene::Model model : {scene::Model::lambert, scene::Model::model_2}) {
    scene::Material material;
    material.model = model;
    material.specular = false;  // it does show its neighbours in what it mirrors
    scene::Scene one{{{ball, material, here}}, lights};
    one.exchange = scene::Exchange::off;
    scene::Scene three = one;
    three.instances.push_back({ball, material, beside});
    three.instances.push_back({ball, material, below});
    const std::vector<float> alone = picture(one, camera, 64, 64, 16);
    const std::vector<float> among = picture(three, camera, 64, 64, 16);
    const Difference found = difference(among, alone, 64, 64);
    EXPECT_LT(found.blocks, 2e-3) << static_cast<int>(model);
  }
}

// A hollow that faces the light is shaded by its own rim: a quarter of a bowl's bottom cannot see a low light.
TEST_F(HeapTest, AHollowObjectShadesItself) {
  const scene::MeshPointer mesh = bumpy();
  EXPECT_FALSE(scene::is_convex(*mesh));
  EXPECT_TRUE(scene::is_convex(scene::unit_sphere(32, 16)));
  EXPECT_TRUE(scene::is_convex(*square(1.0F)));
  // A seam whose two sides differ by rounding is closed.
  const scene::Mesh ball = scene::unit_sphere(32, 16);
  std::vector<glm::vec3> nearly = ball.positions();
  for (std::size_t i = 0; i < nearly.size(); i += 3) nearly[i].y += 1e-7F;
  std::vector<glm::uvec3> triangles = ball.triangles();
  triangles.emplace_back(triangles[0].x, triangles[0].y, triangles[0].x);  // without area
  EXPECT_TRUE(scene::is_convex(scene::Mesh(nearly, ball.normals(), triangles)));
  // Two balls are convex at each edge and shade one another all the same.
  std::vector<glm::vec3> both = ball.positions();
  for (const glm::vec3& position : ball.positions()) both.push_back(position + glm::vec3(3.0F, 0.0F, 0.0F));
  std::vector<glm::uvec3> twice = ball.triangles();
  for (const glm::uvec3& triangle : ball.triangles())
    twice.push_back(triangle + static_cast<unsigned>(ball.positions().size()));
  EXPECT_FALSE(scene::is_convex(scene::Mesh(both, {}, twice)));
  // Two walls at a right angle; a light along the ground meets the standing one's back.
  const auto walls = std::make_shared<scene::Mesh>(
      std::vector<glm::vec3>{{0, -9, 0}, {9, -9, 0}, {9, 9, 0}, {0, 9, 0}, {0, -9, 9}, {0, 9, 9}},
      std::vector<glm::vec3>(), std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}, {0, 3, 5}, {0, 5, 4}});
  EXPECT_FALSE(scene::is_convex(*walls));
  const scene::Camera camera{glm::translate(glm::dmat4(1.0), glm::dvec3(-4, 0, -20)),
                             glm::ortho(-2.0, 2.0, -2.0, 2.0, 0.1, 40.0)};
  const scene::Scene shaded{{{walls, {}, glm::dmat4(1.0)}}, {sun({-1.0, 0.0, 0.5}, pi)}};
  const std::vector<float> dark = picture(shaded, camera, 16, 16, 8);
  EXPECT_NEAR(*std::max_element(dark.begin(), dark.begin() + 1), 0.0F, 1e-6F);
  EXPECT_NEAR(dark[4 * (8 * 16 + 8)], 0.0F, 1e-6F);
  const scene::Scene lit{{{walls, {}, glm::dmat4(1.0)}}, {sun({1.0, 0.0, 0.5}, pi)}};
  EXPECT_GT(picture(lit, camera, 16, 16, 8)[4 * (8 * 16 + 8)], 0.1F);
}

TEST_F(HeapTest, WhatIsSelectedIsWhatTheCameraSees) {
  const auto ball = std::make_shared<scene::Mesh>(scene::unit_sphere(32, 16));
  std::vector<glm::dmat4> places;
  for (int x = 0; x < 40; ++x)
    for (int y = 0; y < 40; ++y)
      places.push_back(glm::translate(glm::dmat4(1.0), glm::dvec3(3.0 * x - 60.0, 3.0 * y - 60.0, 0.0)));
  const scene::Scene everything = array_of(ball, {}, places, {sun({0.5, 0.0, 1.0}, pi)});
  const scene::Camera close = scene::Camera::look_at({0, 0, 20}, {0, 0, 0}, {0, 1, 0}, 30.0);
  std::vector<glm::dmat4> near_places;
  for (const glm::dmat4& place : places)
    if (std::max(std::abs(place[3].x), std::abs(place[3].y)) < 20.0) near_places.push_back(place);
  const scene::Scene nearby = array_of(ball, {}, near_places, everything.lights);
  const Difference found =
      difference(picture(everything, close, 128, 128, 16), picture(nearby, close, 128, 128, 16), 128, 128);
  EXPECT_LT(found.blocks, 2e-3);
}

// Whatever was made for the places stays, and the new material is seen; another place is another picture.
TEST_F(HeapTest, AMaterialChangesWithoutItsInstances) {
  const auto ball = std::make_shared<scene::Mesh>(scene::unit_sphere(16, 8));
  const scene::Camera camera = scene::Camera::look_at({0, 0, 16}, {0, 0, 0}, {0, 1, 0}, 30.0, 2.0);
  for (const Visibility visibility : {Visibility::drawn, Visibility::cast}) {
    View view(64, 32);
    view.set_visibility(visibility);
    view.set_camera(camera);
    const auto shown = [&](const scene::Scene& scene) {
      view.set_scene(scene);
      view.render(4);
      std::vector<float> pixels(64 * 32 * 4);
      view.read(pixels.data());
      return pixels;
    };
    scene::Material material;
    material.reflectance = glm::dvec3(0.2);
    const std::vector<scene::Light> lights = {sun({0.3, 0.2, 1.0}, 3.0)};
    const std::vector<float> dark = shown(array_of(ball, material, eight_places(), lights));
    const std::size_t sent = View::sent().bytes;
    material.reflectance = glm::dvec3(0.4);
    std::vector<float> bright = shown(array_of(ball, material, eight_places(), lights));
    EXPECT_EQ(View::sent().bytes, sent);
    for (std::size_t i = 0; i < bright.size(); ++i)
      if (i % 4 < 3) bright[i] *= 0.5F;
    EXPECT_LT(difference(bright, dark, 64, 32).blocks, 1e-5);
    std::vector<glm::dmat4> moved = eight_places();
    moved[3] = glm::translate(moved[3], glm::dvec3(0.5, 0.5, 0.0));
    const std::vector<float> anew = picture(array_of(ball, material, moved, lights), camera, 64, 32, 4, visibility);
    // The anchor amid the scene stays where it was, so the last digits are others.
    const std::vector<float> there = shown(array_of(ball, material, moved, lights));
    EXPECT_LT(difference(there, anew, 64, 32).blocks, 1e-5);
    std::size_t apart = 0;
    for (std::size_t i = 0; i < anew.size(); ++i) apart += std::abs(there[i] - anew[i]) > 1e-4F;
    EXPECT_LE(apart, anew.size() / 1000);
    const Statistics counts = view.statistics();
    EXPECT_EQ(counts.instances, 8U);
    EXPECT_EQ(visibility == Visibility::cast ? counts.seen : counts.drawn, 8U);
  }
}

TEST_F(HeapTest, ACancelledSampleAddsNothing) {
  const auto ball = std::make_shared<scene::Mesh>(scene::unit_sphere(8, 4));
  const std::vector<glm::dmat4> places(20001, glm::dmat4(1.0));
  View view(64, 64);
  view.set_scene(array_of(ball, {}, places, {sun({0.5, 0.0, 1.0}, pi)}));
  view.set_camera(scene::Camera::look_at({0, 0, 8}, {0, 0, 0}, {0, 1, 0}, 30.0));
  const std::shared_future<double> done = view.start(1000);
  view.cancel();
  done.get();
  EXPECT_LT(view.samples(), 1000);
  const int before = view.samples();
  view.render(1);
  EXPECT_EQ(view.samples(), before + 1);
}

TEST_F(HeapTest, AnArrayWhoseTransformCannotBeInvertedIsRefused) {
  const auto ball = std::make_shared<scene::Mesh>(scene::unit_sphere(8, 4));
  View view(8, 8);
  const scene::Scene scene =
      array_of(ball, {}, {glm::dmat4(1.0), glm::scale(glm::dmat4(1.0), glm::dvec3(1.0, 0.0, 1.0))}, {});
  test::expect_error([&] { view.set_scene(scene); }, "transform must be finite and invertible");
}

}  // namespace
}  // namespace mesograin::render

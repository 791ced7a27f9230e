// Scenes of many meshes: balls among them are those of the tracer of balls, and what is known exactly is found.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <memory>
#include <numbers>

#include "base/error.h"
#include "heap_picture.h"
#include "mesh_heap_picture.h"
#include "scene/sphere.h"

namespace mesograin::referee {
namespace {

constexpr int across = 8;  // pixels

/// Orthographic, along the z axis from above.
MeshHeapCase seen_from_above(double half_width) {
  MeshHeapCase setup;
  setup.clip_to_world = glm::inverse(glm::ortho(-half_width, half_width, -half_width, half_width, 0.0, 100.0) *
                                     glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 0.0, -50.0)));
  setup.width = setup.height = across;
  return setup;
}

scene::MeshPointer ball() {
  static const auto mesh = std::make_shared<const scene::Mesh>(scene::unit_sphere(128, 64));
  return mesh;
}

/// A square across z, its half side 1.
scene::MeshPointer square() {
  const std::vector<glm::vec3> corners{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  return std::make_shared<const scene::Mesh>(corners, std::vector<glm::vec3>(4, {0, 0, 1}),
                                             std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}});
}

/// From -1 to 1 along each axis.
scene::MeshPointer cube() {
  std::vector<glm::vec3> corners;
  corners.reserve(8);
  for (int i = 0; i < 8; ++i) corners.emplace_back(2 * (i & 1) - 1, (i & 2) - 1, (i & 4) / 2 - 1);
  const std::vector<glm::uvec3> faces{{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return std::make_shared<const scene::Mesh>(corners, corners, faces);
}

scene::Material medium(double sigma_s, double sigma_a, double eta) {
  scene::Material material;
  material.model = scene::Model::model_2;
  material.boundary = eta == 1.0 ? scene::Boundary::index_matched : scene::Boundary::dielectric;
  material.sigma_s = glm::dvec3(sigma_s);
  material.sigma_a = glm::dvec3(sigma_a);
  material.eta = eta;
  return material;
}

scene::Material diffuse(double reflectance) {
  scene::Material material;
  material.model = scene::Model::lambert;
  material.reflectance = glm::dvec3(reflectance);
  return material;
}

glm::dmat4 placed(const glm::dvec3& at, double scale = 1.0) {
  return glm::scale(glm::translate(glm::dmat4(1.0), at), glm::dvec3(scale));
}

const std::vector<Ball> three{{{-1.0, 0.0, 0.0}, 1.0}, {{1.0, 0.0, 0.0}, 1.0}, {{0.0, 1.2, 1.4}, 0.8}};

struct Total {
  double sum;
  double noise;  ///< of it, over it
};

Total green_of(const Picture& picture) {
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < picture.radiance.size(); ++i) {
    sum += picture.radiance[i].g;
    squares += picture.noise[i].g * picture.noise[i].g;
  }
  return {sum, std::sqrt(squares) / sum};
}

/// Three balls under a wide sun, by the means of whole pictures, where one is about a hundredth exact.
double by_meshes(const scene::Material& material, const HeapLight& light, double& noise) {
  MeshHeapCase setup = seen_from_above(2.0);
  std::vector<glm::dmat4> places;
  places.reserve(three.size());
  for (const Ball& of : three) places.push_back(placed(of.middle, of.radius));
  setup.scene.arrays.emplace_back(ball(), material, scene::Transforms(places));
  // On a plane that faces it pi, as of balls: a scene tells what a sphere gets.
  const double irradiance = 2.0 * std::numbers::pi / (1.0 + light.cosine);
  setup.scene.lights.emplace_back(
      scene::DirectionalLight{light.direction, glm::dvec3(irradiance), 2.0 * std::acos(light.cosine)});
  setup.samples = 4000;
  const Total total = green_of(trace_mesh_heap(setup));
  noise = total.noise;
  return total.sum;
}

double by_balls(const HeapMaterial& material, const HeapLight& light) {
  HeapCase setup;
  setup.balls = three;
  setup.material = material;
  setup.light = light;
  setup.camera = {{0, 0, 0}, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}, 2.0, 2.0};
  setup.width = setup.height = across;
  setup.samples = 4000;
  double sum = 0;
  for (const HeapRadiance& of : trace_heap(setup).radiance) sum += of.all;
  return sum;
}

TEST(MeshHeap, OfBallsIsTheBalls) {
  const HeapLight sun{.sky = false, .direction = glm::normalize(glm::dvec3(0.5, -0.3, 1.0)), .cosine = std::cos(0.8)};
  for (const double eta : {1.0, 1.5}) {
    double noise = 0;
    const double meshes = by_meshes(medium(1.5, 0.1, eta), sun, noise);
    const double balls = by_balls({.sigma_s = 1.5, .sigma_a = 0.1, .eta = eta}, sun);
    EXPECT_LT(noise, 0.01);
    EXPECT_NEAR(meshes / balls, 1.0, 0.003 + 3.0 * std::numbers::sqrt2 * noise) << eta;
  }
}

// Every path comes back with all that it had.
TEST(MeshHeap, LosesNoLight) {
  MeshHeapCase setup = seen_from_above(1.5);
  setup.scene.world.radiance = glm::dvec3(1.0);
  setup.scene.instances.push_back({ball(), medium(2.0, 0.0, 1.5), placed({0.3, 0.0, 0.0})});
  setup.scene.instances.push_back({ball(), medium(0.0, 0.0, 1.3), placed({-0.8, 0.0, 1.8}, 0.7)});
  setup.scene.instances.push_back({square(), diffuse(1.0), placed({0.0, 0.0, -1.1}, 3.0)});
  setup.samples = 64;
  const Picture picture = trace_mesh_heap(setup);
  for (std::size_t i = 0; i < picture.radiance.size(); ++i) {
    EXPECT_EQ(picture.coverage[i], 1.0);
    EXPECT_NEAR(picture.radiance[i].g, 1.0, 1e-12);
  }
}

// A plane sees of a sun what its share of each point of the disc comes to: E (1 + cos) / 2, times the cosine.
TEST(MeshHeap, LightsAPlaneAsItsSunIsTold) {
  MeshHeapCase setup = seen_from_above(0.5);
  setup.scene.instances.push_back({square(), diffuse(0.6), placed({0.0, 0.0, 0.0})});
  const glm::dvec3 to_light(0.6, 0.0, 0.8);
  const double angle = 1.0;
  setup.scene.lights.emplace_back(scene::DirectionalLight{to_light, glm::dvec3(1.0, 2.0, 3.0), angle});
  setup.samples = 4000;
  const Picture picture = trace_mesh_heap(setup);
  glm::dvec3 mean(0.0);
  for (const glm::dvec3& radiance : picture.radiance) mean += radiance / static_cast<double>(picture.radiance.size());
  const double right = 0.6 / std::numbers::pi * to_light.z * (1.0 + std::cos(0.5 * angle)) / 2.0;
  for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(mean[channel] / (right * (channel + 1)), 1.0, 0.01);
}

// Above the horizon, row 0 of the picture of the world, and along +x its middle column.
TEST(MeshHeap, SeesTheWorldWhereItIs) {
  std::vector<glm::vec3> texels(8 * 4, glm::vec3(0.0F));
  texels[4] = texels[3] = glm::vec3(1.0F, 2.0F, 3.0F);  // high, on both sides of +x
  MeshHeapCase setup = seen_from_above(0.5);
  setup.scene.world.radiance = glm::dvec3(1.0);
  setup.scene.world.image = std::make_shared<const scene::Surroundings>(8, 4, texels);
  setup.scene.instances.push_back({square(), diffuse(1.0), placed({0.0, 0.0, 0.0})});
  setup.samples = 4000;
  const auto mean_of = [&] {
    glm::dvec3 mean(0.0);
    const Picture picture = trace_mesh_heap(setup);
    for (const glm::dvec3& radiance : picture.radiance) mean += radiance / static_cast<double>(picture.radiance.size());
    return mean;
  };
  // A quarter of all azimuths, within 45 degrees of the normal: half of what a Lambertian surface sees.
  const glm::dvec3 upright = mean_of();
  for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(upright[channel], 0.125 * (channel + 1), 0.01);
  // Turned to +x: of the normal's part along it, that patch is the integrals of sin^2 and of cos, over pi.
  const double turn = 0.7;
  setup.scene.instances[0].object_to_world = glm::rotate(glm::dmat4(1.0), turn, glm::dvec3(0.0, 1.0, 0.0));
  const double along_x = (std::numbers::pi / 8.0 - 0.25) * std::numbers::sqrt2 / std::numbers::pi;
  EXPECT_NEAR(mean_of().r, 0.125 * std::cos(turn) + along_x * std::sin(turn), 0.005);
}

// A sphere alone, in another tracer's picture: all but the sun's mirror image, which no camera without extent meets.
TEST(MeshHeap, OfASphereUnderASunWithoutExtentIsTheSpheres) {
  for (const double eta : {1.0, 1.3}) {
    MeshHeapCase setup = seen_from_above(1.2);
    setup.scene.lights.emplace_back(scene::DirectionalLight{{0.8, 0.0, -0.3}, glm::dvec3(1.0, 2.0, 3.0), 0.0});
    scene::Material material = medium(2.0, 0.2, eta);
    material.sigma_s.r = 0.5;
    setup.scene.instances.push_back({ball(), material, placed({0.0, 0.0, 0.0})});
    setup.samples = 1000;
    const Picture found = trace_mesh_heap(setup);
    PictureCase alone;
    alone.material = material;
    alone.lights = {std::get<scene::DirectionalLight>(setup.scene.lights.front())};
    alone.clip_to_world = setup.clip_to_world;
    alone.width = alone.height = across;
    alone.samples = 1000;
    const Picture right = trace_picture(alone);
    for (int channel = 0; channel < 3; ++channel) {
      double sum = 0, other = 0, variance = 0, difference = 0, noise = 0;
      for (std::size_t i = 0; i < right.radiance.size(); ++i) {
        sum += found.radiance[i][channel];
        other += right.radiance[i][channel];
        difference += std::abs(found.radiance[i][channel] - right.radiance[i][channel]);
        const double both = std::hypot(found.noise[i][channel], right.noise[i][channel]);
        noise += both * std::sqrt(2.0 / std::numbers::pi);
        variance += both * both;
      }
      EXPECT_NEAR(sum / other, 1.0, 0.004 + 3.0 * std::sqrt(variance) / other) << eta << ", channel " << channel;
      EXPECT_LT(difference / other, 0.015 + 1.2 * noise / other) << eta << ", channel " << channel;
    }
  }
}

// The same sun, once as it is stored and once as paths find it, which takes many.
TEST(MeshHeap, StoresOfASunWhatPathsFindOfIt) {
  for (const auto& [eta, roughness] : {std::pair{1.5, 0.0}, {1.3, 0.4}}) {
    Total totals[2];
    for (const bool stored : {false, true}) {
      MeshHeapCase setup = seen_from_above(2.0);
      scene::Material material = medium(1.0, 0.02, eta);
      material.roughness = roughness;
      std::vector<glm::dmat4> places;
      places.reserve(three.size());
      for (const Ball& of : three) places.push_back(placed(of.middle, of.radius));
      setup.scene.arrays.emplace_back(ball(), material, scene::Transforms(places));
      setup.scene.instances.push_back({square(), diffuse(0.7), placed({0.0, 0.0, -1.0}, 3.0)});
      // Narrow enough to be stored, and a little too wide for it.
      setup.scene.lights.emplace_back(
          scene::DirectionalLight{{0.5, -0.3, 1.0}, glm::dvec3(1.0), stored ? 0.2999 : 0.3001});
      setup.samples = stored ? 1000 : 8000;
      totals[stored ? 1 : 0] = green_of(trace_mesh_heap(setup));
    }
    const double noise = std::hypot(totals[0].noise, totals[1].noise);
    EXPECT_LT(noise, 0.015);
    EXPECT_NEAR(totals[1].sum / totals[0].sum, 1.0, 0.003 + 3.0 * noise) << eta << ", " << roughness;
  }
}

// Of a pane the series of its two faces crosses, of an index-matched one what it does not absorb; each is seen through,
// too, once more.
TEST(MeshHeap, LightsWhatIsBehindAPane) {
  const double reflectance = 0.02, once = 0.04;
  for (const double eta : {1.5, 1.0}) {
    MeshHeapCase setup = seen_from_above(0.5);
    setup.scene.lights.emplace_back(scene::DirectionalLight{{0.0, 0.0, 1.0}, glm::dvec3(2.0), 0.0});
    setup.scene.instances.push_back({square(), diffuse(reflectance), placed({0.0, 0.0, 0.0}, 8.0)});
    const glm::dmat4 flat = glm::scale(placed({0.0, 0.0, 1.0}), glm::dvec3(1.0, 1.0, 0.5));
    setup.scene.instances.push_back({cube(), medium(0.0, eta == 1.0 ? 0.3 : 0.0, eta), flat});
    setup.samples = 400;
    const Picture picture = trace_mesh_heap(setup);
    double mean = 0;
    for (const glm::dvec3& radiance : picture.radiance) mean += radiance.g / (across * across);
    const double crosses = eta == 1.0 ? std::exp(-0.3) : (1.0 - once) / (1.0 + once);
    const double right = reflectance / std::numbers::pi * 2.0 * crosses * crosses;
    EXPECT_NEAR(mean / right, 1.0, eta == 1.0 ? 1e-3 : 0.01) << eta;
  }
}

// What one facet of a rough surface mirrors of a lamp is found by asking for it, and by chance of a wide sun.
TEST(MeshHeap, MirrorsALampInARoughSurfaceAsAWideSun) {
  Total totals[2];
  for (const bool stored : {false, true}) {
    MeshHeapCase setup = seen_from_above(1.5);
    scene::Material black = medium(0.0, 50.0, 3.0);
    black.roughness = 0.2;
    setup.scene.instances.push_back({ball(), black, placed({0.0, 0.0, 0.0})});
    setup.scene.lights.emplace_back(
        scene::DirectionalLight{{0.5, -0.3, 1.0}, glm::dvec3(1.0), stored ? 0.2999 : 0.3001});
    setup.samples = stored ? 2000 : 60000;
    totals[stored ? 1 : 0] = green_of(trace_mesh_heap(setup));
  }
  EXPECT_LT(totals[0].noise, 0.025);
  EXPECT_LT(totals[1].noise, 0.025);
  EXPECT_NEAR(totals[1].sum / totals[0].sum, 1.0, 0.003 + 3.0 * std::hypot(totals[0].noise, totals[1].noise));
}

// Lamps of every kind on a plane.
TEST(MeshHeap, LightsAPlaneAsItsLampsAreTold) {
  const glm::dvec3 at(0.3, -0.2, 2.0);
  const auto intensity = glm::dvec3(1.0, 2.0, 3.0);
  const auto from = [&](double cosine_exponent, double x, double y) {
    const glm::dvec3 way = at - glm::dvec3(x, y, 0.0);
    const double square = glm::dot(way, way), cosine = way.z / std::sqrt(square);
    return std::pow(cosine, 1.0 + cosine_exponent) / square;
  };
  scene::AreaLight area{.position = at, .half_x = {0.02, 0.0, 0.0}, .half_y = {0.0, 0.02, 0.0}};
  area.radiance = intensity / (0.04 * 0.04);
  scene::SpotLight spot{.position = at, .radiant_intensity = intensity, .angle = 0.3, .blend = 0.2};
  const std::pair<scene::Light, double> lamps[] = {
      {scene::PointLight{.position = at, .radiant_intensity = intensity, .radius = 0.02}, 0.0},
      {area, 1.0},
      {spot, 0.0}};
  for (const auto& [lamp, exponent] : lamps) {
    MeshHeapCase setup = seen_from_above(0.5);
    setup.scene.instances.push_back({square(), diffuse(0.6), placed({0.0, 0.0, 0.0})});
    setup.scene.lights.push_back(lamp);
    setup.samples = 400;
    const Picture picture = trace_mesh_heap(setup);
    for (int row = 0; row < across; ++row)
      for (int column = 0; column < across; ++column) {
        const double x = (column + 0.5) / across - 0.5, y = 0.5 - (row + 0.5) / across;
        double right = 0.6 / std::numbers::pi * from(exponent, x, y);
        if (std::holds_alternative<scene::SpotLight>(lamp)) {
          const double aside = std::hypot(x - at.x, y - at.y), within = std::tan(0.15) * at.z;
          if (std::abs(aside - within) < 0.13) continue;  // its edge, and what it blurs
          if (aside > within) right = 0.0;
        }
        const int pixel = row * across + column;
        const glm::dvec3 found = picture.radiance[static_cast<std::size_t>(pixel)];
        EXPECT_NEAR(found.g, 2.0 * right, 0.02 * 2.0 * right) << lamp.index() << " at " << x << ", " << y;
        EXPECT_NEAR(found.b, 3.0 * right, 0.02 * 3.0 * right);
      }
  }
}

// From afar a lamp of any kind lights a ball as a sun of its irradiance does.
TEST(MeshHeap, SendsOfALampWhatASunSends) {
  const double far = 400.0;
  const glm::dvec3 towards = glm::normalize(glm::dvec3(0.6, 0.3, 0.7));
  scene::AreaLight area{.position = far * towards};
  area.half_x = glm::normalize(glm::cross(towards, glm::dvec3(0.0, 0.0, 1.0)));
  area.half_y = glm::cross(towards, area.half_x);
  if (glm::dot(glm::cross(area.half_x, area.half_y), towards) < 0.0) area.half_y = -area.half_y;
  area.radiance = glm::dvec3(far * far / 4.0);
  const scene::Light lights[] = {
      scene::DirectionalLight{towards, glm::dvec3(1.0), 0.0},
      scene::PointLight{.position = far * towards, .radiant_intensity = glm::dvec3(far * far)}, area,
      scene::SpotLight{.position = far * towards, .axis = -towards, .radiant_intensity = glm::dvec3(far * far)}};
  double sun = 0.0;
  for (const scene::Light& light : lights) {
    MeshHeapCase setup = seen_from_above(1.5);
    setup.scene.lights.push_back(light);
    setup.scene.instances.push_back({ball(), medium(2.0, 0.1, 1.3), placed({0.0, 0.0, 0.0})});
    setup.samples = 400;
    double sum = 0.0;
    for (const glm::dvec3& radiance : trace_mesh_heap(setup).radiance) sum += radiance.g;
    if (light.index() == 0) sun = sum;
    EXPECT_NEAR(sum / sun, 1.0, 0.01) << light.index();
  }
}

TEST(MeshHeap, SaysWhatItCannotTrace) {
  MeshHeapCase setup = seen_from_above(1.0);
  EXPECT_THROW(trace_mesh_heap(setup), Error);
  setup.scene.instances.push_back({ball(), medium(1.0, 0.0, 1.5), placed({0.0, 0.0, 0.0})});
  setup.scene.lights.emplace_back(scene::DirectionalLight{{0.0, 0.0, 1.0}, glm::dvec3(1.0), 0.0});
  setup.scene.instances[0].material.g = 0.5;
  EXPECT_THROW(trace_mesh_heap(setup), Error);
  setup.scene.lights.front() = scene::PointLight{};
  EXPECT_THROW(trace_mesh_heap(setup), Error);
  setup.scene.instances[0].material.g = 0.0;
  setup.scene.lights.front() = scene::AreaLight{.spread = 1.0};
  EXPECT_THROW(trace_mesh_heap(setup), Error);
}

}  // namespace
}  // namespace mesograin::referee

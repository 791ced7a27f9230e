// Pictures of meshes: a sphere's are the sphere's, a cube's are those of another photon Monte Carlo.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "io/exr.h"
#include "io/scene_json.h"
#include "picture.h"
#include "picture_file.h"
#include "rough_interface.h"
#include "scene/sphere.h"

namespace mesograin::referee {
namespace {

constexpr int blocks = 12;

PictureCase sphere_case(double eta, double g) {
  nlohmann::json scene;
  scene["geometry"] = {{"shape", "sphere"}, {"radius", 2.4}};
  scene["camera"] = {{"position", {0, 0, 6.5}}, {"look_at", {0, 0, 0}}, {"fov_degrees", 45}};
  scene["resolution"] = {blocks, blocks};
  scene["lights"] = {{{"type", "distant"}, {"direction_to_light", {-0.3, 0.9, 0.2}}, {"irradiance_linear_rgb", 1}}};
  scene["material"] = {{"kind", "medium"},
                       {"sigma_s", {0.9, 0.999, 0.4}},
                       {"sigma_a", {0.1, 0.001, 0.1}},
                       {"g", g},
                       {"eta", eta},
                       {"boundary", eta == 1 ? "index_matched" : "dielectric"}};
  return picture_case(io::parse_scene(scene.dump(), ""));
}

// Of sphere_case's sphere and of its mesh, by random numbers of their own.
std::pair<Picture, Picture> sphere_and_mesh(PictureCase setup) {
  Picture sphere = trace_picture(setup);
  setup.mesh = std::make_shared<const scene::Mesh>(scene::unit_sphere(128, 64));
  setup.mesh_to_world = glm::dmat4(glm::dmat3(2.4));
  setup.seed = 2;
  return {std::move(sphere), trace_picture(setup)};
}

TEST(MeshPicture, OfASphereIsTheSpheres) {
  for (const auto& [eta, g] : {std::pair{1.3, 0.0}, {1.0, 0.8}}) {
    PictureCase setup = sphere_case(eta, g);
    setup.samples = 300;
    const auto [sphere, mesh] = sphere_and_mesh(setup);
    for (int channel = 0; channel < 3; ++channel) {
      double total = 0, other = 0, difference = 0, noise = 0, variance = 0;
      for (std::size_t block = 0; block < sphere.radiance.size(); ++block) {
        total += mesh.radiance[block][channel];
        other += sphere.radiance[block][channel];
        difference += std::abs(mesh.radiance[block][channel] - sphere.radiance[block][channel]);
        const double both = std::hypot(mesh.noise[block][channel], sphere.noise[block][channel]);
        noise += both * std::sqrt(2 / std::numbers::pi);  // the mean of what is normally distributed, its sign dropped
        variance += both * both;
      }
      EXPECT_NEAR(total / other, 1, 0.005 + 3 * std::sqrt(variance) / other)
          << "eta " << eta << ", channel " << channel;
      EXPECT_LT(difference / other, 0.01 + 1.2 * noise / other) << "eta " << eta << ", channel " << channel;
    }
  }
}

// Light that nothing has scattered falls off within a cell of it: with 112 of them along the side, not 224, 2 to 3 % of
// such a grain's light was missing.
TEST(MeshPicture, OfAThickSphereIsTheSpheres) {
  PictureCase setup = sphere_case(1.3, 0);
  setup.material.sigma_s = setup.material.sigma_a = glm::dvec3(0.5 * 40 / 2.4);
  setup.samples = 400;
  const auto [sphere, mesh] = sphere_and_mesh(setup);
  double total = 0, other = 0, variance = 0;
  for (std::size_t block = 0; block < sphere.radiance.size(); ++block) {
    total += mesh.radiance[block].x;
    other += sphere.radiance[block].x;
    variance += std::pow(mesh.noise[block].x, 2) + std::pow(sphere.noise[block].x, 2);
  }
  EXPECT_NEAR(total / other, 1, 0.01 + 2 * std::sqrt(variance) / other);
}

// Of light that is even everywhere outside, and eta^2 as bright inside (Nicodemus, "Radiance", 1963).
double crosses(const RoughInterface& surface, double from, std::uint64_t seed) {
  constexpr int count = 200000;
  const glm::dvec3 normal(0.36, 0.48, 0.8);
  Rng rng(seed);
  int crossed = 0;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 direction = sample_cosine(from * normal, rng);
    if (glm::dot(surface.beyond(direction, normal, rng), from * normal) > 0) ++crossed;
  }
  return 1.0 * crossed / count;
}

TEST(RoughInterface, LetsOutWhatItLetsIn) {
  for (const double eta : {1.1, 1.5, 1.9})
    for (const double alpha : {0.05, 0.3, 0.8}) {
      const RoughInterface surface{{eta}, alpha};
      EXPECT_NEAR(eta * eta * crosses(surface, 1, 1), crosses(surface, -1, 2), 0.012) << eta << ", " << alpha;
    }
}

TEST(RoughInterface, IsSmoothWhereItsFacetsLieFlat) {
  for (const double eta : {1.1, 1.5, 1.9})
    EXPECT_NEAR(crosses({{eta}, 1e-4}, -1, 3), crosses({{eta}, 0}, -1, 4), 0.003) << eta;
}

TEST(MeshPicture, OfACubeIsAnotherMonteCarlos) {
  const std::string folder = MESOGRAIN_TEST_DATA "/shapes/";
  const nlohmann::json manifest = nlohmann::json::parse(std::ifstream(folder + "manifest.json"));
  int cases = 0;
  for (const nlohmann::json& image : manifest["images"]) {
    const std::string name = image["file"];
    if (name.find("cube_e1.3_R3") != 0) continue;
    nlohmann::json scene;
    scene["geometry"] = {{"shape", "mesh"}, {"file", folder + image["mesh"].get<std::string>()}};
    scene["camera"] = manifest["camera"];
    scene["resolution"] = {blocks, blocks};
    scene["lights"] = {{{"type", "distant"},
                        {"direction_to_light", image["direction_to_light"]},
                        {"irradiance_linear_rgb", image["irradiance"]}}};
    scene["material"] = {{"kind", "medium"},
                         {"sigma_s", image["sigma_s"]},
                         {"sigma_a", image["sigma_a"]},
                         {"eta", image["eta"]},
                         {"boundary", "dielectric"}};
    PictureCase setup = picture_case(io::parse_scene(scene.dump(), ""));
    setup.samples = 400;
    const Picture picture = trace_picture(setup);
    const io::ExrFile truth = io::read_exr(folder + name);
    const auto red = std::find(truth.channels.begin(), truth.channels.end(), "R") - truth.channels.begin();
    const int finer = truth.image.width / blocks;
    double total = 0, other = 0, difference = 0, noise = 0;
    for (int y = 0; y < blocks; ++y)
      for (int x = 0; x < blocks; ++x) {
        double theirs = 0;
        for (int i = 0; i < finer * finer; ++i)
          theirs += truth.image.view().at(x * finer + i % finer, y * finer + i / finer)[red] / (finer * finer);
        const int number = y * blocks + x;
        const auto block = static_cast<std::size_t>(number);
        const double ours = picture.radiance[block].x;
        noise += picture.noise[block].x * std::sqrt(2 / std::numbers::pi);
        total += ours;
        other += theirs;
        difference += std::abs(ours - theirs);
      }
    EXPECT_NEAR(total / other, 1, 0.015) << name;
    EXPECT_LT(difference / other, 0.01 + image["noise_in_blocks"].get<double>() + 1.2 * noise / other) << name;
    ++cases;
  }
  EXPECT_EQ(cases, 3);
}

}  // namespace
}  // namespace mesograin::referee

// Scenes of several objects and their instances in JSON: each place arrives, and every mistake is named with its place.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "base/file.h"
#include "expect_error.h"
#include "io/npy_file.h"
#include "io/scene_json.h"
#include "temporary_folder.h"

namespace mesograin::io {
namespace {

using namespace scene;
using test::expect_error;
using Json = nlohmann::json;

Json heap_scene() {
  return Json::parse(R"({
    "objects": [
      {"geometry": {"shape": "sphere", "radius": 2}, "material": "sand",
       "instances": {"positions": [[1, 2, 3], [4, 5, 6]], "scales": [1, 0.5]}},
      {"geometry": {"shape": "sphere"}, "material": {"kind": "diffuse", "reflectance": 0.5}},
      {"geometry": {"shape": "sphere", "radius": 1}, "material": "sand",
       "instances": {"transforms": [[[0, -1, 0, 7], [1, 0, 0, 8], [0, 0, 1, 9]]]}}],
    "materials": {"sand": {"kind": "subsurface", "sigma_s": 2, "sigma_a": 0.1}},
    "camera": {"position": [0, 0, 6.5], "look_at": [0, 0, 0], "fov_degrees": 45},
    "world": {"radiance_linear_rgb": 1},
    "resolution": [40, 30]})");
}

Json heap_of(const Json& instances) {
  Json scene = heap_scene();
  scene["objects"][1]["geometry"]["radius"] = 1;
  scene["objects"][0]["instances"] = instances;
  return scene;
}

SceneFile parse(const Json& json, const SceneChoices& choices = {}) { return parse_scene(json.dump(), {}, choices); }

Transforms places(const test::TemporaryFolder& folder, const Json& instances) {
  return parse_scene(heap_of(instances).dump(), folder / "", {}).scene.arrays[0].object_to_world();
}

TEST(HeapJson, EveryInstanceArrives) {
  Json scene = heap_scene();
  expect_error([&] { parse(scene); }, "objects[1].geometry.radius is missing");
  scene["objects"][1]["geometry"]["radius"] = 1;
  const SceneFile file = parse(scene);
  ASSERT_EQ(file.scene.instances.size(), 1U);
  EXPECT_EQ(file.scene.instances[0].material.model, Model::lambert);
  ASSERT_EQ(file.scene.arrays.size(), 2U);
  const Transforms& first = file.scene.arrays[0].object_to_world();
  ASSERT_EQ(first.size(), 2U);
  EXPECT_EQ(first[0], glm::scale(glm::translate(glm::dmat4(1.0), {1, 2, 3}), glm::dvec3(2.0)));
  EXPECT_EQ(first[1], glm::scale(glm::translate(glm::dmat4(1.0), {4, 5, 6}), glm::dvec3(1.0)));
  EXPECT_EQ(file.scene.arrays[1].object_to_world()[0] * glm::dvec4(1, 0, 0, 1), glm::dvec4(7, 9, 9, 1));
  EXPECT_EQ(file.scene.arrays[0].mesh, file.scene.arrays[1].mesh) << "one prototype";
  EXPECT_EQ(file.scene.arrays[0].material.sigma_s, glm::dvec3(2.0));
  EXPECT_EQ(materials_of(file.scene).size(), 2U);
}

TEST(HeapJson, TheModelAskedForAnswersWhatItCan) {
  const Json scene = heap_of({{"positions", {{0, 0, 0}}}});
  const SceneFile file = parse(scene, {.model = Model::model_1});
  EXPECT_EQ(file.scene.arrays[0].material.model, Model::model_1);
  EXPECT_EQ(file.scene.instances[0].material.model, Model::lambert);
  expect_error([&] { parse(scene, {.model = Model::conductor}); }, "of a kind that conductor answers");
}

TEST(HeapJson, FilesHoldTransformsPlacesAndSizes) {
  const test::TemporaryFolder folder;
  const auto write = [&](const std::vector<std::size_t>& shape, const std::vector<double>& numbers) {
    base::write_file_atomically(folder / "heap.npy", to_npy({shape, numbers}));
    return places(folder, {{"file", "heap.npy"}});
  };
  const glm::dmat4 twice = glm::scale(glm::dmat4(1.0), glm::dvec3(2.0));  // the sphere's radius
  EXPECT_EQ(write({1, 3}, {1, 2, 3})[0], glm::translate(glm::dmat4(1.0), {1, 2, 3}) * twice);
  EXPECT_EQ(write({1, 4}, {1, 2, 3, 0.5})[0], glm::translate(glm::dmat4(1.0), {1, 2, 3}));
  glm::dmat4 sheared(1.0);
  sheared[1][0] = 0.25;
  sheared[3] = {5, 6, 7, 1};
  EXPECT_EQ(write({1, 3, 4}, {1, .25, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7})[0], sheared * twice);
  EXPECT_EQ(write({2, 4, 4}, {1, 0,   0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,  //
                              1, .25, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7, 0, 0, 0, 1})[1],
            sheared * twice);
  expect_error([&] { write({2}, {1, 2}); }, "its shape must be (n, 4, 4) or (n, 3, 4)");
  expect_error([&] { write({1, 3}, {1, 2}); }, "announces 3 numbers, but it holds 2");
  expect_error([&] { write({0, 3}, {}); }, "must place at least one instance");
  expect_error([&] { write({1, 3}, {1, 2, NAN}); }, "its numbers must be finite; number 2 is nan");
  expect_error([&] { write({1, 4}, {1, 2, 3, 0}); }, "must be finite and invertible");

  base::write_file_atomically(folder / "heap.ply",
                              "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                              "property float z\nproperty float qw\nproperty float qx\nproperty float qy\n"
                              "property float qz\nproperty float scale\nend_header\n1 2 3 2 0 0 2 0.5\n");
  const glm::dvec4 end = places(folder, {{"file", "heap.ply"}})[0] * glm::dvec4(1, 0, 0, 1);
  EXPECT_NEAR(glm::distance(end, glm::dvec4(1, 3, 3, 1)), 0.0, 1e-12) << "a quarter turn about z";
}

TEST(HeapJson, MistakesAreNamedWithTheirPlace) {
  const std::pair<Json, const char*> mistakes[] = {
      {Json::object(), "objects[0].instances must have one of transforms, positions and file"},
      {{{"file", "a.npy"}, {"positions", Json::array()}}, "must have one of transforms, positions and file"},
      {{{"file", "a.txt"}}, "objects[0].instances.file must be a .npy or .ply file"},
      {{{"file", "none.npy"}}, "objects[0].instances.file: There is no file"},
      {{{"transforms", Json::array()}, {"scales", 2}}, "scales must stand beside positions"},
      {{{"transforms", Json::array()}}, "must place at least one instance"},
      {{{"transforms", {{{1, 0, 0, 0}}}}}, "transforms[0] must be a list of 3 or 4 rows"},
      {{{"positions", {{1, 2}}}}, "positions[0] must be a list of 3 numbers"},
      {{{"positions", {{1, 2, 3}}}, {"scales", {1, 2}}}, "scales must be one number, or one for each of the 1"},
      {{{"positions", {{1, 2, 3}}}, {"scales", 0}}, "must be finite and invertible"},
      {{{"places", 1}}, "objects[0].instances.places is an unknown key"},
  };
  for (const auto& [instances, sentence] : mistakes) {
    SCOPED_TRACE(sentence);
    expect_error([&, &json = instances] { parse(heap_of(json)); }, sentence);
  }
  Json scene = heap_of({{"positions", {{1, 2, 3}}}});
  scene["objects"][0]["material"] = "salt";
  expect_error([&] { parse(scene); }, "objects[0].material must be a material, or the name of one of materials");
  scene["geometry"] = 1;
  expect_error([&] { parse(scene); }, "geometry must stand in one of objects");
}

}  // namespace
}  // namespace mesograin::io

// Scenes in JSON: every key arrives where it belongs, and every mistake is named with its place.
#include "io/scene_json.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "base/file.h"
#include "expect_error.h"
#include "temporary_folder.h"

namespace mesograin::io {
namespace {

using namespace scene;
using test::expect_error;
using Json = nlohmann::json;

Json sphere_scene() {
  return Json::parse(R"({
    "about": "provenance says nothing about the scene",
    "geometry": {"shape": "sphere", "centre": [1, 2, 3], "radius": 2.4},
    "camera": {"position": [0, 0, 6.5], "look_at": [0, 0, 0], "up": [0, 1, 0], "fov_degrees": 45,
               "handedness": "right-handed world", "projection": "pinhole perspective, square",
               "pixel_filter": "box, exactly one pixel"},
    "lights": [{"type": "distant", "from_vector": [-1, -1, -1.6],
                "direction_to_light": [-0.4682929, -0.4682929, -0.7492686],
                "irradiance_linear_rgb": [20, 10, 5], "note": "delta"}],
    "resolution": [40, 30],
    "material": {"kind": "smooth_mc", "sigma_s": [0.9, 0.8, 0.7], "sigma_a": 0.1, "eta": 1.5, "scale": 20,
                 "roughness": 0.0, "g": 0.25, "sigma_s_times_scale": [18, 16, 14], "interface": "smooth",
                 "remaproughness": false, "specular": false},
    "seconds_each_render": [1, 2]})");
}

SceneFile parse(const Json& json, const SceneChoices& choices = {}) { return parse_scene(json.dump(), {}, choices); }

TEST(SceneJson, EveryKeyArrives) {
  const SceneFile file = parse(sphere_scene());
  EXPECT_EQ(file.width, 40);
  EXPECT_EQ(file.height, 30);
  ASSERT_EQ(file.scene.instances.size(), 1U);
  const Instance& sphere = file.scene.instances[0];
  EXPECT_EQ(sphere.object_to_world[3], glm::dvec4(1.0, 2.0, 3.0, 1.0));
  EXPECT_EQ(sphere.object_to_world[1][1], 2.4);
  EXPECT_EQ(sphere.material.model, Model::model_2);
  EXPECT_EQ(sphere.material.sigma_s, glm::dvec3(0.9, 0.8, 0.7));
  EXPECT_EQ(sphere.material.sigma_a, glm::dvec3(0.1));
  EXPECT_EQ(sphere.material.eta, 1.5);
  EXPECT_EQ(sphere.material.g, 0.25);
  EXPECT_FALSE(sphere.material.specular);
  EXPECT_EQ(sphere.material.scale, 20.0);
  EXPECT_EQ(sphere.material.boundary, Boundary::dielectric);
  ASSERT_EQ(file.scene.lights.size(), 1U);
  const auto& sun = std::get<DirectionalLight>(file.scene.lights[0]);
  EXPECT_EQ(sun.direction_to_light, glm::dvec3(-1.0, -1.0, -1.6)) << "the exact one of the two";
  EXPECT_EQ(sun.irradiance, glm::dvec3(20.0, 10.0, 5.0));
  EXPECT_EQ(file.camera, Camera::look_at({0, 0, 6.5}, {0, 0, 0}, {0, 1, 0}, 45.0, 40.0 / 30.0));
  EXPECT_EQ(Json::parse(file.source), sphere_scene());
}

TEST(SceneJson, KindsAndInterfacesChooseModelAndBoundary) {
  Json scene = sphere_scene();
  for (const char* kind : {"subsurface", "medium", "smooth_mc"}) {
    scene["material"]["kind"] = kind;
    EXPECT_EQ(parse(scene, {.model = Model::model_2}).scene.instances[0].material.model, Model::model_2);
  }
  scene["material"]["interface"] = "none (index-matched)";
  EXPECT_EQ(parse(scene).scene.instances[0].material.boundary, Boundary::index_matched);
  scene["material"]["interface"] = "GGX alpha 0.3";
  scene["material"]["roughness"] = 0.3;
  EXPECT_EQ(parse(scene).scene.instances[0].material.roughness, 0.3);
  scene["material"].erase("interface");
  scene["material"]["boundary"] = "lambert_refracted";
  scene["material"]["profile"] = "better_dipole";
  scene["material"]["masking"] = "separable";
  const Material material = parse(scene).scene.instances[0].material;
  EXPECT_EQ(material.boundary, Boundary::lambert_refracted);
  EXPECT_EQ(material.profile, Profile::better_dipole);
  EXPECT_EQ(material.masking, Masking::separable);

  scene["material"] = {{"kind", "diffuse"}, {"reflectance", 0.5}};
  EXPECT_EQ(parse(scene).scene.instances[0].material.model, Model::lambert);
  scene["material"] = {{"kind", "conductor"}, {"reflectance", {1.0, 0.9, 0.8}}, {"roughness", 0.4}};
  const Material conductor = parse(scene).scene.instances[0].material;
  EXPECT_EQ(conductor.model, Model::conductor);
  EXPECT_EQ(conductor.reflectance, glm::dvec3(1.0, 0.9, 0.8));
  EXPECT_EQ(conductor.roughness, 0.4);
}

TEST(SceneJson, TheCallerMayChooseTheSize) {
  const SceneFile file = parse(sphere_scene(), {.model = {}, .width = 7, .height = 5});
  EXPECT_EQ(file.width, 7);
  EXPECT_EQ(file.height, 5);
  EXPECT_EQ(file.camera, Camera::look_at({0, 0, 6.5}, {0, 0, 0}, {0, 1, 0}, 45.0, 7.0 / 5.0));
  expect_error([] { require_size({.model = {}, .width = 7, .height = 0}); }, "got 7 x 0");
  expect_error([] { require_size({.model = {}, .width = 20000, .height = 5}); },
               "1 to 16384 pixels a side; got 20000 x 5");
}

TEST(SceneJson, MeshesAreFoundBesideTheFile) {
  const test::TemporaryFolder folder;
  base::write_file_atomically(folder / "triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  Json scene = sphere_scene();
  scene["geometry"] = {{"shape", "mesh"},
                       {"file", "triangle.obj"},
                       {"transform", {{2, 0, 0, 5}, {0, 2, 0, 6}, {0, 0, 2, 7}, {0, 0, 0, 1}}}};
  base::write_file_atomically(folder / "scene.json", scene.dump());
  const SceneFile file = read_scene(folder / "scene.json");
  EXPECT_EQ(file.scene.instances[0].mesh->triangles().size(), 1U);
  EXPECT_EQ(file.scene.instances[0].object_to_world[3], glm::dvec4(5.0, 6.0, 7.0, 1.0));
  scene["geometry"]["file"] = "none.obj";
  base::write_file_atomically(folder / "scene.json", scene.dump());
  expect_error([&] { read_scene(folder / "scene.json"); }, "scene.json: geometry.file: There is no file");
  expect_error([&] { read_scene(folder / "none.json"); }, "There is no file");
}

struct Mistake {
  const char* pointer;  ///< what is replaced, or removed where `value` is empty
  const char* value;
  const char* sentence;
};

TEST(SceneJson, MistakesAreNamedWithTheirPlace) {
  const Mistake mistakes[] = {
      {"/colour", "1", "colour is an unknown key; those allowed in the scene are geometry, camera, resolution"},
      {"/material/sigma_t", "1", "material.sigma_t is an unknown key; those allowed in material are kind, sigma_a"},
      {"/camera/roll", "1", "camera.roll is an unknown key"},
      {"/lights/0/power", "1", "lights[0].power is an unknown key"},
      {"/geometry/height", "1", "geometry.height is an unknown key"},
      {"/geometry", "", "geometry is missing; the scene needs it"},
      {"/lights", "", "lights is missing"},
      {"/lights", "[]", "lights must be a list of at least one light; got []"},
      {"/lights", "3", "lights must be a list of at least one light; got 3"},
      {"/lights/0", "[]", "lights[0] must be an object; got []"},
      {"/lights/0/type", "\"beam\"",
       "lights[0].type must be \"distant\", \"point\", \"spot\" or \"area\"; got \"beam\""},
      {"/lights/0/irradiance_linear_rgb", "[1, 2]", "lights[0].irradiance_linear_rgb must be a number or a list of 3"},
      {"/lights/0/irradiance_linear_rgb", "[1, -2, 3]",
       "irradiance_linear_rgb[1] must be a finite number of at least 0"},
      {"/lights/0/irradiance_linear_rgb", "null", "irradiance_linear_rgb must be a number or a list of 3"},
      {"/lights/0/direction_to_light", "[0, 0, 1]", "must point the same way as from_vector"},
      {"/lights/0/from_vector", "[\"x\", 0, 1]", "lights[0].from_vector[0] must be a number; got \"x\""},
      {"/lights/0/angle", "-1", "lights[0]: "},
      {"/camera/fov_degrees", "180", "camera: fov_degrees must lie between 0 and 180; got 180"},
      {"/camera/look_at", "[0, 0, 6.5]", "camera: A camera needs look_at apart from its position"},
      {"/camera/position", "", "camera.position is missing; camera needs it"},
      {"/camera/projection", "\"orthographic\"", "camera.projection must begin with \"pinhole perspective\""},
      {"/camera/pixel_filter", "\"gaussian\"", "camera.pixel_filter must begin with \"box\""},
      {"/resolution", "", "resolution is missing"},
      {"/resolution", "[400]", "resolution must be a list of width and height; got [400]"},
      {"/resolution", "[400, 0]", "resolution[1] must lie between 1 and 16384; got 0"},
      {"/resolution", "[400, 1.5]", "resolution[1] must be a whole number from 1 to 16384; got 1.5"},
      {"/resolution", "[99999999999, 1]", "resolution[0] must lie between 1 and 16384"},
      {"/geometry/shape", "\"cube\"", "geometry.shape must be \"sphere\" or \"mesh\"; got \"cube\""},
      {"/geometry/radius", "0", "geometry.radius must be greater than 0; got 0"},
      {"/geometry/radius", "-1", "geometry.radius must be greater than 0; got -1"},
      {"/geometry/centre", "[1, 2]", "geometry.centre must be a list of 3 numbers; got [1,2]"},
      {"/material/kind", "\"wood\"", "material.kind must be one of \"diffuse\", \"conductor\""},
      {"/material/kind", "", "material.kind is missing"},
      {"/material/sigma_a", "", "material.sigma_a is missing"},
      {"/material/sigma_a", "-0.1", "material.sigma_a must lie between 0 and"},
      {"/material/sigma_s", "[1, null, 1]", "material.sigma_s[1] must be a number; got null"},
      {"/material/g", "1.5", "material.g must lie between -1 and 1; got 1.5"},
      {"/material/eta", "0", "material.eta must lie between"},
      {"/material/roughness", "true", "material.roughness must be a number; got true"},
      {"/material/specular", "1", "material.specular must be true or false; got 1"},
      {"/material/remaproughness", "true", "material.remaproughness must be false"},
      {"/material/remaproughness", "0", "material.remaproughness must be true or false; got 0"},
      {"/material/interface", "\"rough\"", "material.interface must be \"smooth\", \"GGX alpha <roughness>\""},
      {"/material/interface", "\"GGX alpha 0.3\"", "material.interface must name the roughness, 0"},
      {"/material/boundary", "\"dielectric\"", "material.interface must not stand beside boundary"},
      {"/material/sigma_s_times_scale", "[1, 2, 3]", "must be the product of its two factors"},
  };
  for (const Mistake& mistake : mistakes) {
    SCOPED_TRACE(mistake.sentence);
    Json scene = sphere_scene();
    const Json::json_pointer pointer(mistake.pointer);
    if (*mistake.value == '\0')
      scene[pointer.parent_pointer()].erase(pointer.back());
    else
      scene[pointer] = Json::parse(mistake.value);
    expect_error([&] { parse(scene); }, mistake.sentence);
  }
}

TEST(SceneJson, WhatIsNotJsonIsNamedWithItsLine) {
  expect_error([] { parse_scene("", {}); }, "it is not JSON");
  expect_error([] { parse_scene("{\n\"material\": NaN}", {}); }, "line 2");
  expect_error([] { parse_scene("{\"radius\": 1e999}", {}); }, "number overflow parsing '1e999'");
  expect_error([] { parse_scene("[1, 2]", {}); }, "the scene must be an object; got [1,2]");
  expect_error([] { parse_scene(std::string(100000, '['), {}); }, "it is not JSON");
  expect_error([] { parse_scene("{\"a\xff\": 1}", {}); }, "it is not JSON");
}

TEST(SceneJson, AModelThatDoesNotAnswerTheKindIsRefused) {
  expect_error([] { parse(sphere_scene(), {.model = Model::lambert}); },
               "material.kind is \"smooth_mc\", which model_2 or model_1 or model_3 or transport answers; got the "
               "model lambert");
}

TEST(SceneJson, AMaterialTellsAllItsParameters) {
  const Json json = Json::parse(to_json(parse(sphere_scene()).scene.instances[0].material));
  EXPECT_EQ(json["model"], "model_2");
  EXPECT_EQ(json["boundary"], "dielectric");
  EXPECT_EQ(json["sigma_s"], (Json{0.9, 0.8, 0.7}));
  EXPECT_FALSE(json["specular"].get<bool>());
  EXPECT_EQ(json["reflectance_to_others"], (Json{0.0, 0.0, 0.0}));
  EXPECT_EQ(json.size(), 13U);
}

}  // namespace
}  // namespace mesograin::io

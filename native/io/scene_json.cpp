// Reads a scene key by key: geometry, camera and resolution here, lights and material in files of their own.
#include "io/scene_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "io/instances_json.h"
#include "io/json_node.h"
#include "io/light_json.h"
#include "io/material_json.h"
#include "io/mesh_file.h"
#include "scene/advice.h"
#include "scene/auto.h"
#include "scene/sphere.h"

namespace mesograin::io {

using namespace scene;

namespace {

constexpr int largest_side = 16384;

/// A mesh file is one prototype, however many objects name it.
using Prototypes = std::map<std::string, MeshPointer>;

Instance read_geometry(const Node& node, const std::filesystem::path& folder, Prototypes& prototypes) {
  Instance instance;
  const std::string shape = node["shape"].text();
  if (shape == "sphere") {
    node.require_object(std::array<std::string_view, 3>{"shape", "centre", "radius"}, provenance_keys);
    const double radius = node["radius"].number();
    if (!(radius > 0.0)) node["radius"].fail("must be greater than 0");
    const glm::dvec3 centre = node.has("centre") ? node["centre"].vector() : glm::dvec3(0.0);
    // One mesh for all spheres: what is on the device already need not be sent for the next scene.
    static const MeshPointer sphere = std::make_shared<const Mesh>(unit_sphere());
    instance.mesh = sphere;
    instance.object_to_world = glm::scale(glm::translate(glm::dmat4(1.0), centre), glm::dvec3(radius));
  } else if (shape == "mesh") {
    node.require_object(std::array<std::string_view, 3>{"shape", "file", "transform"}, provenance_keys);
    const std::string name = node["file"].text();
    MeshPointer& mesh = prototypes[name];
    if (!mesh) mesh = at(node["file"], [&] { return std::make_shared<const Mesh>(read_mesh(folder / name)); });
    instance.mesh = mesh;
    if (node.has("transform")) instance.object_to_world = read_transform(node["transform"]);
  } else {
    node["shape"].fail("must be \"sphere\" or \"mesh\"");
  }
  return instance;
}

/// One object, as a whole scene or as one of its `objects`.
void read_object(const Node& node, const Material& material, const std::filesystem::path& folder,
                 Prototypes& prototypes, Scene& scene) {
  Instance instance = read_geometry(node["geometry"], folder, prototypes);
  instance.material = material;
  if (node.has("instances"))
    read_instances(node["instances"], instance, folder, scene.arrays);
  else
    scene.instances.push_back(std::move(instance));
}

constexpr const char* part_of = "part_of";

std::optional<std::uint32_t> read_part_of(const Node& object) {
  if (!object.has(part_of)) return std::nullopt;
  if (object.has("instances")) object[part_of].fail("must not stand beside instances");
  return object[part_of].integer(0, std::numeric_limits<int>::max());
}

/// The materials of a scene of several objects. The model that was asked for answers those whose kind it can, and at
/// least one.
class Materials {
 public:
  Materials(const Node& root, const std::optional<Model>& asked, std::filesystem::path folder)
      : asked_(asked), folder_(std::move(folder)) {
    if (!root.has("materials")) return;
    const Node all = root["materials"];
    if (!all.is_object()) all.fail("must be an object of materials by their names");
    for (const std::string& name : all.keys()) named_.emplace(name, read(all[name]));
  }

  Material of(const Node& node) {
    if (node.is_object()) return read(node);
    const auto found = named_.find(node.text());
    if (found == named_.end()) node.fail("must be a material, or the name of one of materials");
    return found->second;
  }

  void require_asked() const {
    if (asked_ && !answered_) throw Error("No object's material is of a kind that {} answers.", name_of(*asked_));
  }

 private:
  Material read(const Node& node) {
    const bool answers = asked_ && answers_kind(node["kind"], *asked_);
    answered_ = answered_ || answers;
    return read_material(node, answers ? asked_ : std::nullopt, folder_);
  }

  std::optional<Model> asked_;
  std::filesystem::path folder_;
  bool answered_ = false;
  std::map<std::string, Material> named_;
};

void read_objects(const Node& root, const std::filesystem::path& folder, const SceneChoices& choices, Scene& scene) {
  Prototypes prototypes;
  if (!root.has("objects")) {
    read_object(root, read_material(root["material"], choices.model, folder), folder, prototypes, scene);
    at(root["geometry"], [&] { validate(scene); });
    return;
  }
  for (const char* key : {"geometry", "material", "instances"})
    if (root.has(key)) throw Error("{} must stand in one of objects, since there are objects.", key);
  const Node objects = root["objects"];
  if (objects.size() == 0) objects.fail("must be a list of at least one object");
  Materials materials(root, choices.model, folder);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Node object = objects[i];
    object.require_object(std::array<std::string_view, 4>{"geometry", "material", "instances", part_of},
                          provenance_keys);
    const std::optional<std::uint32_t> whole = read_part_of(object);
    read_object(object, materials.of(object["material"]), folder, prototypes, scene);
    if (whole) scene.instances.back().object = whole;
  }
  materials.require_asked();
  at(objects, [&] { validate(scene); });
}

/// Gives each translucent object the model that scene::advise has for it, with this tolerance in %; an array's by the
/// size of its middle instance.
void choose_models(Scene& scene, double tolerance) {
  const auto choose = [tolerance](Material& material, const MeshPointer& mesh, const glm::dmat4& to_world) {
    if (traits_of(material.model).translucent)
      material.model = advise(material, shape_of(*mesh, glm::dmat3(to_world)), tolerance).model;
  };
  for (Instance& instance : scene.instances) choose(instance.material, instance.mesh, instance.object_to_world);
  for (InstanceArray& array : scene.arrays) {
    std::vector<glm::dmat4> matrices;
    matrices.reserve(array.object_to_world().size());
    for (const glm::dmat4 matrix : array.object_to_world()) matrices.push_back(matrix);
    if (matrices.empty()) continue;
    const auto middle = matrices.begin() + static_cast<std::ptrdiff_t>(matrices.size() / 2);
    const auto size = [](const glm::dmat4& matrix) { return std::abs(glm::determinant(glm::dmat3(matrix))); };
    std::ranges::nth_element(matrices, middle, {}, size);
    choose(array.material, array.mesh, *middle);
  }
}

/// A word about the camera or a material that must say what Mesograin does anyway.
void require_text(const Node& node, const char* key, std::string_view beginning) {
  if (node.has(key) && !node[key].text().starts_with(beginning)) node[key].fail("must begin with \"{}\"", beginning);
}

/// Of a camera, if it has one.
std::optional<Lens> read_lens(const Node& camera) {
  if (!camera.has("lens")) return {};
  const Node node = camera["lens"];
  node.require_object(
      std::array<std::string_view, 5>{"aperture_radius", "focus_distance", "blades", "rotation", "ratio"});
  Lens lens{node["aperture_radius"].number(), node["focus_distance"].number()};
  if (node.has("blades")) lens.blades = node["blades"].integer(0, 1000);
  if (node.has("rotation")) lens.rotation = node["rotation"].number();
  if (node.has("ratio")) lens.ratio = node["ratio"].number();
  at(node, [&] { validate(lens); });
  return lens;
}

/// As two matrices, which say all that a camera may be but for its lens.
Camera read_camera_matrices(const Node& node) {
  node.require_object(std::array<std::string_view, 3>{"world_to_camera", "camera_to_clip", "lens"}, provenance_keys);
  const Camera camera{read_transform(node["world_to_camera"]), read_transform(node["camera_to_clip"]), read_lens(node)};
  at(node, [&] { validate(camera); });
  return camera;
}

Camera read_camera(const Node& node, double aspect) {
  if (node.is_object() && (node.has("world_to_camera") || node.has("camera_to_clip")))
    return read_camera_matrices(node);
  node.require_object(std::array<std::string_view, 8>{"position", "look_at", "up", "fov_degrees", "handedness",
                                                      "projection", "pixel_filter", "lens"},
                      provenance_keys);
  require_text(node, "handedness", "right-handed");
  require_text(node, "projection", "pinhole perspective");
  require_text(node, "pixel_filter", "box");
  const glm::dvec3 position = node["position"].vector();
  const glm::dvec3 look_at = node["look_at"].vector();
  const glm::dvec3 up = node.has("up") ? node["up"].vector() : glm::dvec3(0.0, 1.0, 0.0);
  const double fov_degrees = node["fov_degrees"].number();
  return at(node, [&] {
    Camera camera = Camera::look_at(position, look_at, up, fov_degrees, aspect);
    camera.lens = read_lens(node);
    validate(camera);
    return camera;
  });
}

SceneFile read(const Json& json, const std::filesystem::path& folder, const SceneChoices& choices) {
  const Node root(json, "");
  root.require_object(
      std::array<std::string_view, 11>{"geometry", "camera", "resolution", "lights", "world", "material", "instances",
                                       "objects", "materials", "exchange", "denoise"},
      provenance_keys);
  SceneFile file;
  file.width = choices.width;
  file.height = choices.height;
  if (choices.width == 0) {
    const Node resolution = root["resolution"];
    if (resolution.size() != 2) resolution.fail("must be a list of width and height");
    file.width = resolution[std::size_t{0}].integer(1, largest_side);
    file.height = resolution[1].integer(1, largest_side);
  }
  file.scene.lights = read_lights(root);
  if (root.has("world")) file.scene.world = read_world(root["world"], folder);
  if (choices.exchange)
    file.scene.exchange = *choices.exchange;
  else if (root.has("exchange"))
    file.scene.exchange = at(root["exchange"], [&] { return parse_choice<Exchange>(root["exchange"].text()); });
  if (root.has("denoise")) file.scene.denoise = root["denoise"].boolean();
  read_objects(root, folder, choices, file.scene);
  if (choices.automatic) choose_models(file.scene, choices.tolerance);
  file.camera = read_camera(root["camera"], static_cast<double>(file.width) / file.height);
  file.source = json.dump(-1, ' ', true, Json::error_handler_t::replace);
  return file;
}

/// nlohmann's own words without its error's number.
std::string syntax_error(const Json::exception& error) {
  std::string text = error.what();
  const std::size_t bracket = text.find("] ");
  if (bracket != std::string::npos) text.erase(0, bracket + 2);
  for (char& letter : text)
    if (static_cast<unsigned char>(letter) < ' ') letter = ' ';
  return text;
}

}  // namespace

void choose_model(SceneChoices& choices, std::string_view name) {
  choices.automatic = name == automatic::name;
  if (!choices.automatic) choices.model = parse_model(name);
}

std::vector<std::string> models_to_choose() {
  std::vector<std::string> names(model_names.begin(), model_names.end());
  names.emplace_back(automatic::name);
  return names;
}

void require_size(const SceneChoices& choices) {
  if (choices.width == 0 && choices.height == 0) return;
  if (std::min(choices.width, choices.height) < 1 || std::max(choices.width, choices.height) > largest_side)
    throw Error("A picture needs 1 to {} pixels a side; got {} x {}.", largest_side, choices.width, choices.height);
}

SceneFile parse_scene(std::string_view text, const std::filesystem::path& folder, const SceneChoices& choices) {
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::exception& error) {
    throw Error("it is not JSON, which has no NaN, Infinity or comments: {}.", syntax_error(error));
  }
  return read(json, folder, choices);
}

SceneFile read_scene(const std::filesystem::path& path, const SceneChoices& choices) {
  const std::string text = base::read_file(path);
  try {
    return parse_scene(text, path.parent_path(), choices);
  } catch (const Error& error) {
    throw Error("Can't use {}: {}", path.string(), error.what());
  }
}

}  // namespace mesograin::io

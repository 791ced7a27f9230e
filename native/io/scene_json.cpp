// Reads a scene key by key: geometry, camera and resolution here, lights and material in files of their own.
#include "io/scene_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "io/json_node.h"
#include "io/light_json.h"
#include "io/material_json.h"
#include "io/mesh_file.h"
#include "scene/sphere.h"

namespace mesograin::io {

using namespace scene;

namespace {

constexpr int largest_side = 16384;

Instance read_geometry(const Node& node, const std::filesystem::path& folder) {
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
    instance.mesh = at(node["file"], [&] { return std::make_shared<Mesh>(read_mesh(folder / node["file"].text())); });
    if (node.has("transform")) {
      const Node rows = node["transform"];
      if (rows.size() != 4) rows.fail("must be a list of 4 rows");
      for (int row = 0; row < 4; ++row) {
        const Node numbers = rows[static_cast<std::size_t>(row)];
        if (numbers.size() != 4) numbers.fail("must be a list of 4 numbers");
        for (int column = 0; column < 4; ++column)
          instance.object_to_world[column][row] = numbers[static_cast<std::size_t>(column)].number();
      }
    }
  } else {
    node["shape"].fail("must be \"sphere\" or \"mesh\"");
  }
  return instance;
}

/// A word about the camera or a material that must say what Mesograin does anyway.
void require_text(const Node& node, const char* key, std::string_view beginning) {
  if (node.has(key) && !node[key].text().starts_with(beginning)) node[key].fail("must begin with \"{}\"", beginning);
}

Camera read_camera(const Node& node, double aspect) {
  node.require_object(std::array<std::string_view, 7>{"position", "look_at", "up", "fov_degrees", "handedness",
                                                      "projection", "pixel_filter"},
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
    validate(camera);
    return camera;
  });
}

SceneFile read(const Json& json, const std::filesystem::path& folder, const SceneChoices& choices) {
  const Node root(json, "");
  root.require_object(
      std::array<std::string_view, 6>{"geometry", "camera", "resolution", "lights", "world", "material"},
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
  Instance instance = read_geometry(root["geometry"], folder);
  instance.material = read_material(root["material"], choices.model);
  file.scene.instances.push_back(std::move(instance));
  file.camera = read_camera(root["camera"], static_cast<double>(file.width) / file.height);
  at(root["geometry"], [&] { validate(file.scene); });
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

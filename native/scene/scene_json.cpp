// Reads a scene key by key; a Node knows its place in the file, so that every mistake is named where it stands.
#include "scene/scene_json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <initializer_list>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>
#include <vector>

#include "file/file.h"
#include "scene/error.h"
#include "scene/mesh_file.h"
#include "scene/number.h"
#include "scene/sphere.h"

namespace mesograin::scene {
namespace {

using Json = nlohmann::json;

constexpr int largest_side = 16384;

/// The best model for translucent grains.
constexpr Model translucent_model = Model::model_2;

/// What tells how a reference was made, and nothing about the scene.
constexpr std::array<std::string_view, 28> provenance_keys{"about",
                                                           "cautions",
                                                           "composite_of",
                                                           "engine",
                                                           "file",
                                                           "halves",
                                                           "images",
                                                           "integrator",
                                                           "light_set",
                                                           "mask",
                                                           "max",
                                                           "maxdepth",
                                                           "method",
                                                           "name",
                                                           "noise",
                                                           "note",
                                                           "noise_rse_max",
                                                           "noise_rse_mean",
                                                           "noise_relative_to_mean",
                                                           "mean_inside_mask",
                                                           "pbrt_commit",
                                                           "seconds_each_render",
                                                           "seeds",
                                                           "sensor",
                                                           "spp_per_half",
                                                           "symmetry",
                                                           "units",
                                                           "wavelengths"};

/// A value and its place.
class Node {
 public:
  Node(const Json& value, std::string path) : value_(value), path_(std::move(path)) {}

  template <typename... Arguments>
  [[noreturn]] void fail(fmt::format_string<Arguments...> need, Arguments&&... arguments) const {
    throw Error("{} {}; got {}.", path_.empty() ? "the scene" : path_,
                fmt::format(need, std::forward<Arguments>(arguments)...), brief());
  }

  const std::string& path() const { return path_; }
  bool is_number() const { return value_.is_number(); }

  /// Refuses keys that are neither in `known` nor in `ignored`.
  void require_object(std::span<const std::string_view> known, std::span<const std::string_view> ignored = {}) const {
    if (!value_.is_object()) fail("must be an object");
    for (const auto& item : value_.items())
      if (std::find(known.begin(), known.end(), item.key()) == known.end() &&
          std::find(ignored.begin(), ignored.end(), item.key()) == ignored.end())
        throw Error("{} is an unknown key; those allowed {} are {}.", child_path(item.key()),
                    path_.empty() ? "in the scene" : "in " + path_, fmt::join(known, ", "));
  }

  bool has(const char* key) const { return value_.contains(key); }
  Node operator[](const char* key) const {
    if (!has(key)) throw Error("{} is missing; {} needs it.", child_path(key), path_.empty() ? "the scene" : path_);
    return {value_.at(key), child_path(key)};
  }

  std::size_t size() const { return value_.is_array() ? value_.size() : 0; }
  Node operator[](std::size_t index) const { return {value_.at(index), fmt::format("{}[{}]", path_, index)}; }

  double number(double low = -std::numeric_limits<double>::max(),
                double high = std::numeric_limits<double>::max()) const {
    if (!value_.is_number()) fail("must be a number");
    const double number = value_.get<double>();
    if (!(number >= low && number <= high)) {
      if (high == std::numeric_limits<double>::max()) fail("must be a finite number of at least {}", low);
      fail("must lie between {} and {}", low, high);
    }
    return number;
  }

  int integer(int low, int high) const {
    if (!value_.is_number_integer()) fail("must be a whole number from {} to {}", low, high);
    return static_cast<int>(number(low, high));
  }

  std::string text() const {
    if (!value_.is_string()) fail("must be text");
    return value_.get<std::string>();
  }

  bool boolean() const {
    if (!value_.is_boolean()) fail("must be true or false");
    return value_.get<bool>();
  }

  glm::dvec3 vector() const {
    if (size() != 3) fail("must be a list of 3 numbers");
    return {(*this)[std::size_t{0}].number(), (*this)[1].number(), (*this)[2].number()};
  }

  /// One number for all channels, or a list of three.
  glm::dvec3 rgb(double high = std::numeric_limits<double>::max()) const {
    if (value_.is_number()) return glm::dvec3(number(0.0, high));
    if (size() != 3) fail("must be a number or a list of 3 numbers");
    return {(*this)[std::size_t{0}].number(0.0, high), (*this)[1].number(0.0, high), (*this)[2].number(0.0, high)};
  }

 private:
  std::string child_path(std::string_view key) const {
    const std::string name = key.size() <= 60 ? std::string(key) : std::string(key.substr(0, 60)) + "...";
    return path_.empty() ? name : fmt::format("{}.{}", path_, name);
  }

  std::string brief() const {
    std::string text = value_.dump(-1, ' ', true, Json::error_handler_t::replace);
    if (text.size() > 60) text = text.substr(0, 60) + "...";
    return text;
  }

  const Json& value_;
  std::string path_;
};

/// Holds a sentence of another room against the key that it is about.
template <typename Action>
auto at(const Node& node, Action action) {
  try {
    return action();
  } catch (const Error& error) {
    throw Error("{}: {}", node.path(), error.what());
  }
}

bool agree(const glm::dvec3& a, const glm::dvec3& b) {
  return glm::length(a - b) <= 1e-5 * (glm::length(a) + glm::length(b));
}

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

DirectionalLight read_light(const Node& node) {
  node.require_object(
      std::array<std::string_view, 5>{"type", "direction_to_light", "from_vector", "irradiance_linear_rgb", "angle"},
      provenance_keys);
  if (node["type"].text() != "distant") node["type"].fail("must be \"distant\"");
  DirectionalLight light;
  if (!node.has("from_vector") && !node.has("direction_to_light"))
    throw Error("{}.direction_to_light is missing; a light needs it.", node.path());
  // Both name the same direction; from_vector is the one that was not rounded.
  light.direction_to_light = node[node.has("from_vector") ? "from_vector" : "direction_to_light"].vector();
  if (node.has("from_vector") && node.has("direction_to_light") &&
      !agree(glm::normalize(light.direction_to_light), glm::normalize(node["direction_to_light"].vector())))
    node["direction_to_light"].fail("must point the same way as from_vector");
  light.irradiance = node["irradiance_linear_rgb"].rgb();
  if (node.has("angle")) light.angle = node["angle"].number();
  at(node, [&] { validate(light); });
  return light;
}

std::vector<DirectionalLight> read_lights(const Node& node) {
  if (node.size() == 0) node.fail("must be a list of at least one light");
  std::vector<DirectionalLight> lights;
  for (std::size_t i = 0; i < node.size(); ++i) lights.push_back(read_light(node[i]));
  return lights;
}

/// `interface` says in words what `boundary` says in one of Mesograin's names.
Boundary read_boundary(const Node& node) {
  if (node.has("boundary")) {
    if (node.has("interface")) node["interface"].fail("must not stand beside boundary, which says the same");
    return at(node["boundary"], [&] { return parse_boundary(node["boundary"].text()); });
  }
  if (!node.has("interface")) return Boundary::dielectric;
  const std::string interface = node["interface"].text();
  if (interface == "none (index-matched)") return Boundary::index_matched;
  constexpr std::string_view rough = "GGX alpha ";
  if (interface.starts_with(rough)) {
    const auto alpha = parse_float(std::string_view(interface).substr(rough.size()));
    const double roughness = node.has("roughness") ? node["roughness"].number() : 0.0;
    if (!alpha || std::abs(*alpha - roughness) > 1e-6) node["interface"].fail("must name the roughness, {}", roughness);
  } else if (interface != "smooth") {
    node["interface"].fail("must be \"smooth\", \"GGX alpha <roughness>\" or \"none (index-matched)\"");
  }
  return Boundary::dielectric;
}

void require_product(const Node& node, const char* key, const glm::dvec3& product) {
  if (node.has(key) && !agree(node[key].rgb(), product))
    node[key].fail("must be the product of its two factors, [{}, {}, {}]", product.x, product.y, product.z);
}

void read_translucent(const Node& node, Material& material) {
  node.require_object(std::array<std::string_view, 15>{"kind", "sigma_s", "sigma_a", "g", "eta", "scale", "roughness",
                                                       "interface", "boundary", "masking", "profile", "remaproughness",
                                                       "specular", "sigma_s_times_scale", "sigma_a_times_scale"},
                      provenance_keys);
  material.sigma_s = node["sigma_s"].rgb();
  material.sigma_a = node["sigma_a"].rgb();
  if (node.has("g")) material.g = node["g"].number();
  if (node.has("eta")) material.eta = node["eta"].number();
  if (node.has("scale")) material.scale = node["scale"].number();
  if (node.has("specular")) material.specular = node["specular"].boolean();
  if (node.has("profile"))
    material.profile = at(node["profile"], [&] { return parse_profile(node["profile"].text()); });
  material.boundary = read_boundary(node);
  require_product(node, "sigma_s_times_scale", material.sigma_s * material.scale);
  require_product(node, "sigma_a_times_scale", material.sigma_a * material.scale);
}

/// The models that answer a kind, the best first.
std::vector<Model> models_of(const Node& kind) {
  const std::string name = kind.text();
  if (name == "diffuse") return {Model::lambert};
  if (name == "conductor") return {Model::conductor};
  if (name == "subsurface" || name == "medium" || name == "smooth_mc") {
    std::vector<Model> models{translucent_model};
    for (const Model model : {Model::model_1, Model::model_2, Model::model_3})
      if (model != translucent_model) models.push_back(model);
    return models;
  }
  kind.fail("must be \"diffuse\", \"conductor\", \"subsurface\", \"medium\" or \"smooth_mc\"");
}

std::string_view name_of(Model model) { return model_names[static_cast<std::size_t>(model)]; }

Material read_material(const Node& node, const std::optional<Model>& asked) {
  const std::vector<Model> models = models_of(node["kind"]);
  Material material;
  material.model = asked.value_or(models.front());
  if (std::find(models.begin(), models.end(), material.model) == models.end()) {
    std::vector<std::string_view> names;
    names.reserve(models.size());
    for (const Model model : models) names.push_back(name_of(model));
    throw Error("{}.kind is \"{}\", which {} answers; got the model {}.", node.path(), node["kind"].text(),
                fmt::join(names, " or "), name_of(material.model));
  }
  switch (models.front()) {
    case Model::lambert:
      node.require_object(std::array<std::string_view, 2>{"kind", "reflectance"}, provenance_keys);
      material.reflectance = node["reflectance"].rgb(1.0);
      break;
    case Model::conductor:
      node.require_object(
          std::array<std::string_view, 5>{"kind", "reflectance", "roughness", "masking", "remaproughness"},
          provenance_keys);
      material.reflectance = node["reflectance"].rgb(1.0);
      break;
    default:
      read_translucent(node, material);
  }
  if (node.has("roughness")) material.roughness = node["roughness"].number();
  if (node.has("masking"))
    material.masking = at(node["masking"], [&] { return parse_masking(node["masking"].text()); });
  if (node.has("remaproughness") && node["remaproughness"].boolean())
    node["remaproughness"].fail("must be false, because roughness is the GGX alpha itself");
  at(node, [&] { validate(material); });
  return material;
}

SceneFile read(const Json& json, const std::filesystem::path& folder, const SceneChoices& choices) {
  const Node root(json, "");
  root.require_object(std::array<std::string_view, 5>{"geometry", "camera", "resolution", "lights", "material"},
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
  file.scene.lights = read_lights(root["lights"]);
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
  const std::string text = file::read_file(path);
  try {
    return parse_scene(text, path.parent_path(), choices);
  } catch (const Error& error) {
    throw Error("Can't use {}: {}", path.string(), error.what());
  }
}

std::string to_json(const Material& material) {
  const auto list = [](const glm::dvec3& v) { return Json{v.x, v.y, v.z}; };
  return Json{{"model", name_of(material.model)},
              {"reflectance", list(material.reflectance)},
              {"sigma_a", list(material.sigma_a)},
              {"sigma_s", list(material.sigma_s)},
              {"g", material.g},
              {"eta", material.eta},
              {"roughness", material.roughness},
              {"scale", material.scale},
              {"specular", material.specular},
              {"boundary", boundary_names[static_cast<std::size_t>(material.boundary)]},
              {"masking", masking_names[static_cast<std::size_t>(material.masking)]},
              {"profile", profile_names[static_cast<std::size_t>(material.profile)]}}
      .dump();
}

}  // namespace mesograin::scene

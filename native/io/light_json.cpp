// One reader for each type of light; the world's image is an EXR file.
#include "io/light_json.h"

#include <memory>
#include <string>

#include "base/error.h"
#include "io/exr.h"

namespace mesograin::io {

using namespace scene;

namespace {

DirectionalLight read_directional_light(const Node& node) {
  node.require_object(std::array<std::string_view, 6>{"type", "direction_to_light", "from_vector",
                                                      "irradiance_linear_rgb", "angle", "flat"},
                      provenance_keys);
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
  if (node.has("flat")) light.flat = node["flat"].boolean();
  return light;
}

/// What a point light and a spot have in common.
template <typename Ball>
void read_ball(const Node& node, Ball& light) {
  light.position = node["position"].vector();
  light.radiant_intensity = node["radiant_intensity_linear_rgb"].rgb();
  if (node.has("radius")) light.radius = node["radius"].number();
  if (!node.has("shape")) return;
  const std::string shape = node["shape"].text();
  if (shape != "disc" && shape != "sphere") node["shape"].fail("must be \"disc\" or \"sphere\"");
  light.shape = shape == "disc" ? LightShape::disc : LightShape::sphere;
}

PointLight read_point_light(const Node& node) {
  node.require_object(
      std::array<std::string_view, 5>{"type", "position", "radiant_intensity_linear_rgb", "radius", "shape"},
      provenance_keys);
  PointLight light;
  read_ball(node, light);
  return light;
}

SpotLight read_spot_light(const Node& node) {
  node.require_object(std::array<std::string_view, 11>{"type", "position", "radiant_intensity_linear_rgb", "radius",
                                                       "shape", "axis", "angle", "blend", "cosine", "wide_x", "wide_y"},
                      provenance_keys);
  SpotLight light;
  read_ball(node, light);
  light.axis = node["axis"].vector();
  light.angle = node["angle"].number();
  if (node.has("blend")) light.blend = node["blend"].number();
  if (node.has("cosine")) light.cosine = node["cosine"].boolean();
  if (node.has("wide_x") || node.has("wide_y")) {
    light.wide_x = node["wide_x"].vector();
    light.wide_y = node["wide_y"].vector();
  }
  return light;
}

AreaLight read_area_light(const Node& node) {
  node.require_object(std::array<std::string_view, 8>{"type", "position", "half_x", "half_y", "radiance_linear_rgb",
                                                      "ellipse", "spread", "drawn"},
                      provenance_keys);
  AreaLight light;
  light.position = node["position"].vector();
  light.half_x = node["half_x"].vector();
  light.half_y = node["half_y"].vector();
  light.radiance = node["radiance_linear_rgb"].rgb();
  if (node.has("ellipse")) light.ellipse = node["ellipse"].boolean();
  if (node.has("spread")) light.spread = node["spread"].number();
  if (node.has("drawn")) light.drawn = node["drawn"].boolean();
  return light;
}

Light read_light(const Node& node) {
  if (!node.is_object()) node.fail("must be an object");
  const std::string type = node["type"].text();
  Light light;
  if (type == "distant")
    light = read_directional_light(node);
  else if (type == "point")
    light = read_point_light(node);
  else if (type == "spot")
    light = read_spot_light(node);
  else if (type == "area")
    light = read_area_light(node);
  else
    node["type"].fail("must be \"distant\", \"point\", \"spot\" or \"area\"");
  at(node, [&] { validate(light); });
  return light;
}

std::shared_ptr<const Surroundings> read_surroundings(const std::filesystem::path& path) {
  const ExrFile file = read_exr(path);
  const image::Image& picture = file.image;
  if (picture.channels < 3)
    throw Error("A world's image needs the channels R, G and B; {} has {}.", path.string(), picture.channels);
  std::vector<glm::vec3> texels;
  texels.reserve(picture.pixels.size() / static_cast<std::size_t>(picture.channels));
  for (std::size_t i = 0; i < picture.pixels.size(); i += static_cast<std::size_t>(picture.channels))
    texels.emplace_back(picture.pixels[i], picture.pixels[i + 1], picture.pixels[i + 2]);
  return std::make_shared<const Surroundings>(picture.width, picture.height, std::move(texels));
}

Json listed(const glm::dvec3& vector) { return {vector.x, vector.y, vector.z}; }

const char* name_of(LightShape shape) { return shape == LightShape::disc ? "disc" : "sphere"; }

Json written(const DirectionalLight& light) {
  return {{"type", "distant"},
          {"direction_to_light", listed(light.direction_to_light)},
          {"irradiance_linear_rgb", listed(light.irradiance)},
          {"angle", light.angle},
          {"flat", light.flat}};
}

Json written(const PointLight& light) {
  return {{"type", "point"},
          {"position", listed(light.position)},
          {"radiant_intensity_linear_rgb", listed(light.radiant_intensity)},
          {"radius", light.radius},
          {"shape", name_of(light.shape)}};
}

Json written(const SpotLight& light) {
  return {{"type", "spot"},
          {"position", listed(light.position)},
          {"axis", listed(light.axis)},
          {"radiant_intensity_linear_rgb", listed(light.radiant_intensity)},
          {"radius", light.radius},
          {"shape", name_of(light.shape)},
          {"angle", light.angle},
          {"blend", light.blend},
          {"cosine", light.cosine},
          {"wide_x", listed(light.wide_x)},
          {"wide_y", listed(light.wide_y)}};
}

Json written(const AreaLight& light) {
  return {{"type", "area"},
          {"position", listed(light.position)},
          {"half_x", listed(light.half_x)},
          {"half_y", listed(light.half_y)},
          {"radiance_linear_rgb", listed(light.radiance)},
          {"ellipse", light.ellipse},
          {"spread", light.spread},
          {"drawn", light.drawn}};
}

// around: a World or a Backdrop.
template <typename Around>
void read_around(Around& around, const Node& node, const std::filesystem::path& folder) {
  around.radiance = glm::dvec3(1.0);
  if (node.has("radiance_linear_rgb") || !node.has("image")) around.radiance = node["radiance_linear_rgb"].rgb();
  if (node.has("image"))
    around.image = at(node["image"], [&] { return read_surroundings(folder / node["image"].text()); });
  if (!node.has("world_to_image")) return;
  const Node rows = node["world_to_image"];
  if (rows.size() != 3) rows.fail("must be a list of 3 rows");
  for (int row = 0; row < 3; ++row) {
    const glm::dvec3 numbers = rows[static_cast<std::size_t>(row)].vector();
    for (int column = 0; column < 3; ++column) around.world_to_image[column][row] = numbers[column];
  }
}

}  // namespace

Json to_json(const Light& light) {
  return std::visit([](const auto& kind) { return written(kind); }, light);
}

/// Without a light there must be a world.
std::vector<Light> read_lights(const Node& root) {
  if (!root.has("lights") && root.has("world")) return {};
  const Node node = root["lights"];
  if (node.size() == 0 && !root.has("world")) node.fail("must be a list of at least one light");
  std::vector<Light> lights;
  for (std::size_t i = 0; i < node.size(); ++i) lights.push_back(read_light(node[i]));
  return lights;
}

World read_world(const Node& node, const std::filesystem::path& folder) {
  node.require_object(std::array<std::string_view, 6>{"radiance_linear_rgb", "image", "world_to_image", "seen",
                                                      "backdrop", "film_transparent"},
                      provenance_keys);
  World world;
  read_around(world, node, folder);
  if (node.has("seen")) world.seen = node["seen"].boolean();
  if (node.has("film_transparent")) world.film_transparent = node["film_transparent"].boolean();
  if (node.has("backdrop")) {
    const Node backdrop = node["backdrop"];
    backdrop.require_object(std::array<std::string_view, 3>{"radiance_linear_rgb", "image", "world_to_image"});
    read_around(world.backdrop.emplace(), backdrop, folder);
  }
  at(node, [&] { validate(world); });
  return world;
}

}  // namespace mesograin::io

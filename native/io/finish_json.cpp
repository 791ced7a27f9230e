// Each quantity that a picture may say, by its name; then the numbers.
#include "io/finish_json.h"

#include <fmt/format.h>

#include <array>
#include <glm/common.hpp>
#include <memory>
#include <string_view>
#include <variant>

#include "io/exr.h"
#include "scene/material.h"

namespace mesograin::io {

using namespace scene;

namespace {

constexpr std::array map_names{std::pair{"reflectance_map", &Finish::reflectance},
                               std::pair{"roughness_map", &Finish::roughness},
                               std::pair{"metallic_map", &Finish::metallic}, std::pair{"normal_map", &Finish::normal},
                               std::pair{"emission_map", &Finish::emission}};
constexpr std::array number_names{
    std::pair{"metallicity", &Finish::metallicity}, std::pair{"normal_strength", &Finish::normal_strength},
    std::pair{"coat", &Finish::coat}, std::pair{"coat_roughness", &Finish::coat_roughness},
    std::pair{"diffuse_roughness", &Finish::diffuse_roughness}};
constexpr std::array switch_names{std::pair{"retro_reflective", &Finish::retro_reflective},
                                  std::pair{"coat_shades_base", &Finish::coat_shades_base},
                                  std::pair{"metal_whitens", &Finish::metal_whitens},
                                  std::pair{"facets_keep_energy", &Finish::facets_keep_energy},
                                  std::pair{"facets_shade_bumps", &Finish::facets_shade_bumps},
                                  std::pair{"bent_normals_stay", &Finish::bent_normals_stay},
                                  std::pair{"faces_are_lights", &Finish::faces_are_lights}};

std::shared_ptr<const Picture> read_picture(const std::filesystem::path& path, bool srgb) {
  const ExrFile file = read_exr(path);
  const image::Image& image = file.image;
  if (image.channels != 1 && image.channels < 3)
    throw Error("A picture needs the channels R, G and B, or one; {} has {}.", path.string(), image.channels);
  const auto channels = static_cast<std::size_t>(image.channels);
  Picture::Numbers texels;
  texels.reserve(image.pixels.size() / channels);
  for (std::size_t i = 0; i < image.pixels.size(); i += channels) {
    const float* texel = &image.pixels[i];
    texels.push_back(channels == 1 ? glm::vec4(glm::vec3(texel[0]), 1.0F)
                                   : glm::vec4(texel[0], texel[1], texel[2], 1.0F));
  }
  return std::make_shared<const Picture>(image.width, image.height, std::move(texels), srgb);
}

TextureMap read_map(const Node& node, const std::filesystem::path& folder) {
  node.require_object(std::array<std::string_view, 6>{"image", "encoding", "by", "to_image", "wrap", "smooth"},
                      provenance_keys);
  TextureMap map;
  bool srgb = false;
  if (node.has("encoding")) {
    const std::string encoding = node["encoding"].text();
    if (encoding != "linear" && encoding != "srgb") node["encoding"].fail("must be \"linear\" or \"srgb\"");
    srgb = encoding == "srgb";
  }
  map.picture = at(node["image"], [&] { return read_picture(folder / node["image"].text(), srgb); });
  if (node.has("by")) {
    const std::string by = node["by"].text();
    if (by != "uv" && by != "position") node["by"].fail("must be \"uv\" or \"position\"");
    map.by_position = by == "position";
  }
  if (node.has("to_image")) {
    const Node rows = node["to_image"];
    if (rows.size() != 2) rows.fail("must be a list of 2 rows");
    for (std::size_t row = 0; row < 2; ++row) {
      if (rows[row].size() != 4) rows[row].fail("must be a list of 4 numbers");
      for (std::size_t column = 0; column < 4; ++column)
        map.to_picture[row][static_cast<int>(column)] = rows[row][column].number();
    }
  }
  if (node.has("wrap"))
    map.wrap = at(node["wrap"], [&] { return static_cast<Wrap>(find_name("wrap", wrap_names, node["wrap"].text())); });
  if (node.has("smooth")) map.smooth = node["smooth"].boolean();
  return map;
}

// Bytes and numbers alike.
void write_picture(const Picture& picture, const std::filesystem::path& path) {
  image::Image image{picture.width(), picture.height(), 3, {}};
  std::visit(
      [&](const auto& texels) {
        constexpr float most = std::is_same_v<std::decay_t<decltype(texels)>, Picture::Bytes> ? 255.0F : 1.0F;
        for (const auto& texel : texels)
          for (int channel = 0; channel < 3; ++channel)
            image.pixels.push_back(static_cast<float>(texel[channel]) / most);
      },
      picture.texels());
  write_exr(path, image.view());
}

Json written_map(const TextureMap& map, const std::filesystem::path& folder, const std::string& file) {
  write_picture(*map.picture, folder / file);
  Json rows = Json::array();
  for (const glm::dvec4& row : map.to_picture) rows.push_back({row.x, row.y, row.z, row.w});
  return {{"image", file},
          {"encoding", map.picture->srgb() ? "srgb" : "linear"},
          {"by", map.by_position ? "position" : "uv"},
          {"to_image", std::move(rows)},
          {"wrap", wrap_names[static_cast<std::size_t>(map.wrap)]},
          {"smooth", map.smooth}};
}

}  // namespace

Finish read_finish(const Node& node, const std::filesystem::path& folder) {
  std::vector<std::string_view> keys{"radiance_linear_rgb"};
  for (const auto& [name, member] : map_names) keys.emplace_back(name);
  for (const auto& [name, member] : number_names) keys.emplace_back(name);
  for (const auto& [name, member] : switch_names) keys.emplace_back(name);
  node.require_object(keys, provenance_keys);
  Finish finish;
  for (const auto& [name, member] : map_names)
    if (node.has(name)) finish.*member = read_map(node[name], folder);
  for (const auto& [name, member] : number_names)
    if (node.has(name)) finish.*member = node[name].number();
  for (const auto& [name, member] : switch_names)
    if (node.has(name)) finish.*member = node[name].boolean();
  if (node.has("radiance_linear_rgb")) finish.radiance = node["radiance_linear_rgb"].rgb();
  at(node, [&] { validate(finish); });
  return finish;
}

Json written_finish(const Finish& finish, const std::filesystem::path& folder, const std::string& prefix) {
  Json json = Json::object();
  for (const auto& [name, member] : map_names)
    if ((finish.*member).picture)
      json[name] = written_map(finish.*member, folder, fmt::format("{}_{}.exr", prefix, name));
  for (const auto& [name, member] : number_names) json[name] = finish.*member;
  for (const auto& [name, member] : switch_names) json[name] = finish.*member;
  json["radiance_linear_rgb"] = {finish.radiance.r, finish.radiance.g, finish.radiance.b};
  return json;
}

}  // namespace mesograin::io

// A scene as JSON with the files beside it that hold what is long.
#include <fmt/format.h>

#include <glm/gtc/type_ptr.hpp>
#include <map>
#include <span>
#include <string>

#include "base/file.h"
#include "io/exr.h"
#include "io/finish_json.h"
#include "io/light_json.h"
#include "io/mesh_file.h"
#include "io/npy_file.h"
#include "io/scene_json.h"

namespace mesograin::io {

using namespace scene;

namespace {

Json rows_of(const glm::dmat4& matrix) {
  const glm::dmat4 rows = glm::transpose(matrix);
  Json list = Json::array();
  for (int row = 0; row < 4; ++row) list.push_back({rows[row].x, rows[row].y, rows[row].z, rows[row].w});
  return list;
}

/// Of `all`, what the model reads: as read_material takes it.
Json parameters_json(const Material& material) {
  const ModelTraits& traits = traits_of(material.model);
  const Json all = Json::parse(to_json(material));
  Json json{{"kind", traits.kinds.front()}};
  for (const std::string_view parameter : traits.parameters)
    json[std::string(parameter)] = all.at(std::string(parameter));
  return json;
}

class Writer {
 public:
  explicit Writer(const std::filesystem::path& path) : path_(path) {}

  Json objects(const Scene& scene) {
    Json list = Json::array();
    for (const Instance& instance : scene.instances) {
      list.push_back(
          {{"geometry", geometry(instance.mesh, instance.object_to_world)}, {"material", material(instance.material)}});
      if (instance.object) list.back()["part_of"] = *instance.object;
    }
    for (std::size_t i = 0; i < scene.arrays.size(); ++i) {
      const InstanceArray& array = scene.arrays[i];
      const std::string file = beside(fmt::format("instances_{}.npy", i));
      NumberArray numbers{{array.object_to_world().size(), 4, 4}, {}};
      numbers.numbers.reserve(16 * numbers.shape[0]);
      for (const glm::dmat4 transform : array.object_to_world()) {
        const glm::dmat4 rows = glm::transpose(transform);
        const std::span<const double> values(glm::value_ptr(rows), 16);
        numbers.numbers.insert(numbers.numbers.end(), values.begin(), values.end());
      }
      base::write_file_atomically(path_.parent_path() / file, to_npy(numbers));
      Json instances{{"file", file}};
      if (array.factors().any()) instances["factors"] = factors(array.factors(), i);
      list.push_back({{"geometry", geometry(array.mesh, glm::dmat4(1.0))},
                      {"material", material(array.material)},
                      {"instances", std::move(instances)}});
    }
    return list;
  }

  Json world(const World& world) {
    Json json = around(world, "world.exr");
    json["seen"] = world.seen;
    if (world.film_transparent) json["film_transparent"] = true;
    if (world.backdrop) json["backdrop"] = around(*world.backdrop, "backdrop.exr");
    return json;
  }

 private:
  // Of a World or a Backdrop, whose image is written beside the scene.
  template <typename Around>
  Json around(const Around& around, const char* image_name) {
    Json json{{"radiance_linear_rgb", {around.radiance.r, around.radiance.g, around.radiance.b}}};
    if (!around.image) return json;
    const std::string file = beside(image_name);
    image::Image picture{around.image->width(), around.image->height(), 3, {}};
    for (const glm::vec3& texel : around.image->texels())
      picture.pixels.insert(picture.pixels.end(), {texel.r, texel.g, texel.b});
    write_exr(path_.parent_path() / file, picture.view());
    json["image"] = file;
    const glm::dmat3 rows = glm::transpose(around.world_to_image);
    for (int row = 0; row < 3; ++row) json["world_to_image"].push_back({rows[row].x, rows[row].y, rows[row].z});
    return json;
  }

  std::string beside(const std::string& what) const { return path_.stem().string() + "_" + what; }

  Json material(const Material& material) {
    Json json = parameters_json(material);
    if (material.finish)
      json["finish"] =
          written_finish(*material.finish, path_.parent_path(), beside(fmt::format("finish_{}", finishes_++)));
    return json;
  }

  Json factors(const ColourFactors& factors, std::size_t number) {
    Json json = Json::object();
    const auto add = [&](const char* name, const std::vector<glm::vec3>& numbers) {
      if (numbers.empty()) return;
      const std::string file = beside(fmt::format("{}_{}.npy", name, number));
      NumberArray rows{{numbers.size(), 3}, {}};
      for (const glm::vec3& row : numbers) rows.numbers.insert(rows.numbers.end(), {row.r, row.g, row.b});
      base::write_file_atomically(path_.parent_path() / file, to_npy(rows));
      json[name] = file;
    };
    add("sigma_a", factors.sigma_a);
    add("sigma_s", factors.sigma_s);
    add("reflectance", factors.reflectance);
    return json;
  }

  Json geometry(const MeshPointer& mesh, const glm::dmat4& object_to_world) {
    std::string& file = meshes_[mesh.get()];
    if (file.empty()) {
      file = beside(fmt::format("mesh_{}.ply", meshes_.size() - 1));
      base::write_file_atomically(path_.parent_path() / file, to_ply(*mesh));
    }
    Json json{{"shape", "mesh"}, {"file", file}};
    if (object_to_world != glm::dmat4(1.0)) json["transform"] = rows_of(object_to_world);
    return json;
  }

  std::filesystem::path path_;
  std::map<const Mesh*, std::string> meshes_;
  std::size_t finishes_ = 0;
};

Json lens(const Lens& lens) {
  return {{"aperture_radius", lens.aperture_radius},
          {"focus_distance", lens.focus_distance},
          {"blades", lens.blades},
          {"rotation", lens.rotation},
          {"ratio", lens.ratio}};
}

}  // namespace

void write_scene(const std::filesystem::path& path, const SceneFile& file) {
  base::require_writable(path);
  Writer writer(path);
  Json json{{"objects", writer.objects(file.scene)},
            {"camera",
             {{"world_to_camera", rows_of(file.camera.world_to_camera)},
              {"camera_to_clip", rows_of(file.camera.camera_to_clip)}}},
            {"resolution", {file.width, file.height}},
            {"world", writer.world(file.scene.world)},
            {"exchange", exchange_names[static_cast<std::size_t>(file.scene.exchange)]},
            {"denoise", file.scene.denoise},
            {"lights", Json::array()}};
  if (file.camera.lens) json["camera"]["lens"] = lens(*file.camera.lens);
  for (const Light& light : file.scene.lights) json["lights"].push_back(to_json(light));
  base::write_file_atomically(path, json.dump(1) + "\n");
}

}  // namespace mesograin::io

// Reads the sphere out of a scene, writes the picture with its noise beside it.
#include "picture_file.h"

#include <glm/matrix.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>

#include "base/error.h"
#include "io/exr.h"

namespace mesograin::referee {
namespace {

void write(const std::filesystem::path& path, const io::SceneFile& file, const auto& setup, const Picture& picture,
           std::map<std::string, std::string> made_by) {
  image::Image pixels{.width = setup.width, .height = setup.height, .channels = 7, .pixels = {}};
  for (std::size_t pixel = 0; pixel < picture.radiance.size(); ++pixel) {
    for (int channel = 0; channel < 3; ++channel)
      pixels.pixels.push_back(static_cast<float>(picture.radiance[pixel][channel]));
    pixels.pixels.push_back(static_cast<float>(picture.coverage[pixel]));
    for (int channel = 0; channel < 3; ++channel)
      pixels.pixels.push_back(static_cast<float>(picture.noise[pixel][channel]));
  }
  made_by.insert({{"mesograin:version", MESOGRAIN_VERSION},
                  {"mesograin:scene", file.source},
                  {"mesograin:samples", std::to_string(setup.samples)},
                  {"mesograin:seed", std::to_string(setup.seed)},
                  {"mesograin:units",
                   "linear RGB radiance, premultiplied by the coverage in A; noise is its standard error; "
                   "coefficients per scene unit"},
                  {"mesograin:pixel_filter", "box, one pixel"}});
  io::write_exr(path, pixels.view(), {"R", "G", "B", "A", "noise.R", "noise.G", "noise.B"}, made_by);
}

}  // namespace

PictureCase picture_case(const io::SceneFile& file) {
  const nlohmann::json source = nlohmann::json::parse(file.source);  // already read once, and found complete
  const nlohmann::json& geometry = source.at("geometry");
  const bool mesh = geometry.at("shape") == "mesh";
  if (!mesh && geometry.at("shape") != "sphere")
    throw Error("The referee traces spheres and meshes: geometry.shape must be 'sphere' or 'mesh'; got '{}'.",
                geometry.at("shape").get<std::string>());
  const std::string kind = source.at("material").at("kind");
  if (kind == "diffuse" || kind == "conductor")
    throw Error("The referee traces media: material.kind must be 'subsurface', 'medium' or 'smooth_mc'; got '{}'.",
                kind);
  PictureCase setup;
  if (geometry.contains("centre"))
    for (int axis = 0; axis < 3; ++axis) setup.centre[axis] = geometry["centre"][static_cast<std::size_t>(axis)];
  if (mesh) {
    setup.mesh = file.scene.instances.front().mesh;
    setup.mesh_to_world = file.scene.instances.front().object_to_world;
  } else {
    setup.radius = geometry.at("radius");
  }
  setup.material = file.scene.instances.front().material;
  for (const scene::Light& light : file.scene.lights) {
    const auto* sun = std::get_if<scene::DirectionalLight>(&light);
    if (sun == nullptr) throw Error("The referee knows suns: every light's type must be 'distant'.");
    setup.lights.push_back(*sun);
  }
  setup.clip_to_world = glm::inverse(file.camera.camera_to_clip * file.camera.world_to_camera);
  setup.width = file.width;
  setup.height = file.height;
  return setup;
}

bool is_heap(const io::SceneFile& file) {
  const nlohmann::json source = nlohmann::json::parse(file.source);
  return source.contains("objects") || source.contains("instances");
}

MeshHeapCase mesh_heap_case(const io::SceneFile& file) {
  MeshHeapCase setup;
  setup.scene = file.scene;
  setup.clip_to_world = glm::inverse(file.camera.camera_to_clip * file.camera.world_to_camera);
  setup.width = file.width;
  setup.height = file.height;
  return setup;
}

void write_picture(const std::filesystem::path& path, const io::SceneFile& file, const PictureCase& setup,
                   const Picture& picture) {
  write(path, file, setup, picture,
        {{"mesograin:method", "photon Monte Carlo, backward, smooth interface; light of at least one scattering"},
         {"mesograin:material", io::to_json(setup.material)}});
}

void write_picture(const std::filesystem::path& path, const io::SceneFile& file, const MeshHeapCase& setup,
                   const Picture& picture) {
  write(path, file, setup, picture,
        {{"mesograin:method",
          "path tracing of meshes; light scattered, reflected or refracted at least once, found by leaving"}});
}

}  // namespace mesograin::referee

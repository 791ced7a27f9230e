// Reads what a heap is made of, writes the picture with its shares beside it.
#include "heap_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "base/error.h"
#include "io/exr.h"

namespace mesograin::referee {
namespace {

glm::dvec3 vector(const nlohmann::json& of) { return {of.at(0), of.at(1), of.at(2)}; }

/// A number, or one for each channel.
double channel_of(const nlohmann::json& of, std::size_t channel) {
  return of.is_array() ? of.at(channel).get<double>() : of.get<double>();
}

std::vector<Ball> read_balls(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw Error("A heap needs its spheres; '{}' could not be read.", path.string());
  std::vector<Ball> balls;
  std::string line;
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream numbers(line);
    Ball ball{};
    if (numbers >> ball.middle.x >> ball.middle.y >> ball.middle.z >> ball.radius) balls.push_back(ball);
  }
  if (balls.empty()) throw Error("'{}' has no spheres: a line each of x, y, z and radius was needed.", path.string());
  return balls;
}

HeapMaterial material_of(const nlohmann::json& source, std::size_t channel) {
  HeapMaterial material;
  if (source.at("kind") == "diffuse") {
    material.diffuse = true;
    material.reflectance = channel_of(source.at("reflectance"), channel);
    return material;
  }
  material.sigma_s = channel_of(source.at("sigma_s"), channel);
  material.sigma_a = channel_of(source.at("sigma_a"), channel);
  material.g = source.value("g", 0.0);
  material.eta = source.value("eta", 1.0);
  return material;
}

HeapLight light_of(const nlohmann::json& source) {
  HeapLight light;
  light.sky = source.at("type") == "hemisphere";
  if (light.sky) return light;
  light.direction = glm::normalize(vector(source.at("direction_to_light")));
  light.cosine = std::cos(0.5 * source.value("angle", 0.0));
  return light;
}

bool same(const HeapMaterial& a, const HeapMaterial& b) {
  return a.reflectance == b.reflectance && a.sigma_s == b.sigma_s && a.sigma_a == b.sigma_a;
}

}  // namespace

std::vector<HeapCase> heap_cases(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw Error("A heap in JSON was needed; '{}' could not be read.", path.string());
  try {
    const nlohmann::json source = nlohmann::json::parse(file);
    HeapCase common;
    common.balls = read_balls(path.parent_path() / source.at("spheres").get<std::string>());
    const nlohmann::json& camera = source.at("camera");
    common.camera = {vector(camera.at("centre")), vector(camera.at("direction")), vector(camera.at("right")),
                     vector(camera.at("up")),     camera.at("half_width"),        camera.at("half_height")};
    common.width = source.at("resolution").at(0);
    common.height = source.at("resolution").at(1);
    common.light = light_of(source.at("light"));
    std::vector<HeapCase> cases;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      common.material = material_of(source.at("material"), channel);
      cases.push_back(common);
    }
    if (same(cases[0].material, cases[1].material) && same(cases[0].material, cases[2].material)) cases.resize(1);
    return cases;
  } catch (const nlohmann::json::exception& error) {
    throw Error("'{}' is no heap: {}", path.string(), error.what());
  }
}

void write_heap(const std::filesystem::path& path, const std::vector<HeapCase>& cases,
                const std::vector<HeapPicture>& pictures) {
  const HeapCase& setup = cases.front();
  image::Image pixels{.width = setup.width, .height = setup.height, .channels = 8, .pixels = {}};
  const std::size_t green = pictures.size() / 2;
  for (std::size_t pixel = 0; pixel < pictures[green].radiance.size(); ++pixel) {
    const HeapRadiance& of = pictures[green].radiance[pixel];
    for (std::size_t channel = 0; channel < 3; ++channel)
      pixels.pixels.push_back(static_cast<float>(pictures[std::min(channel, pictures.size() - 1)].radiance[pixel].all));
    for (const double value : {of.direct, of.crossed, of.behind, of.alone, pictures[green].noise[pixel]})
      pixels.pixels.push_back(static_cast<float>(value));
  }
  io::write_exr(path, pixels.view(), {"R", "G", "B", "direct.G", "crossed.G", "behind.G", "alone.G", "noise.G"},
                {{"mesograin:version", MESOGRAIN_VERSION},
                 {"mesograin:method", "path tracing of balls; light scattered, reflected or refracted at least once"},
                 {"mesograin:samples", std::to_string(setup.samples)},
                 {"mesograin:seed", std::to_string(setup.seed)},
                 {"mesograin:units", "linear radiance; noise is its standard error; lengths in scene units"},
                 {"mesograin:pixel_filter", "box, one pixel"}});
}

}  // namespace mesograin::referee

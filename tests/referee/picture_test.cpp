// Pictures against another Monte Carlo's, against the forward walk, and as files.
#include "picture.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <numbers>

#include "base/error.h"
#include "io/exr.h"
#include "picture_file.h"
#include "sphere.h"
#include "stored_table.h"
#include "walk.h"

namespace mesograin::referee {
namespace {

using scene::Boundary;

PictureCase parse(const nlohmann::json& scene) { return picture_case(io::parse_scene(scene.dump(), "")); }

nlohmann::json thesis_scene(double sigma_s, double sigma_a, double eta, double scale) {
  nlohmann::json scene;
  scene["geometry"] = {{"shape", "sphere"}, {"radius", 2.4}};
  scene["camera"] = {{"position", {0, 0, 6.5}}, {"look_at", {0, 0, 0}}, {"fov_degrees", 45}};
  scene["resolution"] = {16, 16};
  scene["lights"] = {{{"type", "distant"}, {"direction_to_light", {1, 1, 1}}, {"irradiance_linear_rgb", {20, 20, 20}}}};
  scene["material"] = {
      {"kind", "smooth_mc"}, {"sigma_s", sigma_s}, {"sigma_a", sigma_a}, {"eta", eta}, {"scale", scale}};
  return scene;
}

TEST(Picture, AgreesWithAnotherMonteCarloInEveryPart) {
  const StoredTable stored("photon_blocks.json");
  for (const nlohmann::json& other : stored.cases()) {
    nlohmann::json scene = thesis_scene(other["sigma_s"], other["sigma_a"], other["eta"], other["scale"]);
    scene["lights"][0]["direction_to_light"] = other["direction_to_light"];
    PictureCase setup = parse(scene);
    setup.samples = 2048;
    setup.seed = 71;
    const Picture picture = trace_picture(setup);
    double total = 0, other_total = 0, difference = 0, variance = 0;
    for (std::size_t block = 0; block < picture.radiance.size(); ++block) {
      const double theirs = other["radiance"][block];
      total += picture.radiance[block].x;
      other_total += theirs;
      difference += std::abs(picture.radiance[block].x - theirs);
      variance += picture.noise[block].x * picture.noise[block].x;
    }
    EXPECT_NEAR(total / other_total, 1, 0.003 + 3 * std::sqrt(variance) / total) << other["name"];
    EXPECT_LT(difference / other_total, 0.03) << other["name"];
  }
}

struct FarField {
  Boundary boundary;
  double radius, albedo, eta, g;
};

/// Flux per solid angle, around the cosine between view and light, per incident flux: by forward photons.
struct IntensityVisitor {
  const FarField& field;
  double from, to;
  double& sum;

  void scattered(const glm::dvec3&, const glm::dvec3&, int, double) {}
  void left(const glm::dvec3&, const glm::dvec3& normal, const glm::dvec3& direction, int order, double weight) {
    if (order == 0) return;
    const double cosine = field.eta == 1 ? direction.z : refract(direction, -normal, 1 / field.eta).z;
    if (cosine >= from && cosine < to) sum += weight * std::pow(field.albedo, order);
  }
};

TEST(Picture, IsWhatForwardPhotonsGive) {
  for (const FarField& field :
       {FarField{Boundary::dielectric, 2.4, 0.9, 1.3, 0}, FarField{Boundary::dielectric, 6, 0.8, 1.6, 0},
        FarField{Boundary::dielectric, 2, 0.95, 1.4, 0.7}, FarField{Boundary::index_matched, 3, 0.9, 1, -0.4}}) {
    constexpr double cosine = 0.4, width = 0.1;
    const auto forward =
        run_batches({400'000, 72, 0}, 1, [&](Rng& rng, std::uint64_t photons, std::span<double> tally) {
          IntensityVisitor visitor{field, cosine - width / 2, cosine + width / 2, tally[0]};
          const Interface interface { field.eta };
          for (std::uint64_t i = 0; i < photons; ++i) {
            const double square = (static_cast<double>(i) + rng.uniform()) / static_cast<double>(photons);
            const glm::dvec3 normal(std::sqrt(square), 0, std::sqrt(1 - square));
            Photon photon{field.radius * normal, {0, 0, -1}, 1 - interface.reflectance_from_outside(normal.z)};
            if (!interface.matched()) photon.direction = refract(photon.direction, normal, field.eta);
            walk(Sphere{field.radius}, interface, Medium{1, field.g}, photon, rng, visitor);
          }
        });
    const double solid_angle = 2 * std::numbers::pi * width;

    // The same from so far away that all view rays are parallel: one pixel just holds the sphere.
    constexpr double distance = 1e4;
    const double degrees = 2 * std::asin(1.0001 / distance) * 180 / std::numbers::pi;
    nlohmann::json scene = thesis_scene(field.albedo * field.radius, (1 - field.albedo) * field.radius, field.eta, 1);
    scene["geometry"]["radius"] = 1;
    scene["camera"] = {{"position", {0, 0, distance}}, {"look_at", {0, 0, 0}}, {"fov_degrees", degrees}};
    scene["lights"][0] = {{"type", "distant"},
                          {"direction_to_light", {std::sqrt(1 - cosine * cosine), 0, cosine}},
                          {"irradiance_linear_rgb", {1, 1, 1}}};
    scene["resolution"] = {1, 1};
    scene["material"]["g"] = field.g;
    scene["material"]["boundary"] = scene::boundary_names[static_cast<std::size_t>(field.boundary)];
    PictureCase setup = parse(scene);
    setup.samples = 150'000;
    const Picture picture = trace_picture(setup);
    const double side = 2 * distance * std::tan(degrees * std::numbers::pi / 360);
    const double scale = side * side / std::numbers::pi;  // image area over the flux caught from unit irradiance
    const double noise = std::hypot(forward[0].noise / solid_angle, picture.noise[0].x * scale);
    EXPECT_NEAR(picture.radiance[0].x * scale, forward[0].value / solid_angle, 4 * noise)
        << "eta " << field.eta << ", g " << field.g;
    EXPECT_LT(noise, 0.02 * picture.radiance[0].x * scale);
  }
}

/// Mean pi L / E over the pixels whose cosine to a light at right angles to a far camera is in [from, to).
Estimate band(Boundary boundary, double eta, double from, double to) {
  constexpr int size = 80;
  constexpr double distance = 2.4e4;
  nlohmann::json scene = thesis_scene(0.9, 0.1, eta, 1);
  scene["camera"] = {{"position", {0, 0, distance}},
                     {"look_at", {0, 0, 0}},
                     {"fov_degrees", 2 * std::asin(2.4 / distance) * 180 / std::numbers::pi}};
  scene["lights"][0] = {{"type", "distant"}, {"direction_to_light", {1, 0, 0}}, {"irradiance_linear_rgb", {1, 1, 1}}};
  scene["resolution"] = {size, size};
  scene["material"]["boundary"] = scene::boundary_names[static_cast<std::size_t>(boundary)];
  PictureCase setup = parse(scene);
  setup.samples = 36;
  const Picture picture = trace_picture(setup);
  double sum = 0, variance = 0, count = 0;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * size + static_cast<std::size_t>(x);
      const double cosine = (x + 0.5) * 2 / size - 1;
      if (cosine < from || cosine >= to || picture.coverage[pixel] < 1) continue;
      sum += picture.radiance[pixel].x;
      variance += picture.noise[pixel].x * picture.noise[pixel].x;
      ++count;
    }
  }
  return {std::numbers::pi * sum / count, std::numbers::pi * std::sqrt(variance) / count};
}

TEST(Picture, WithCosineLobesOnBothSidesIsTheExitance) {
  const SphereResult exitance =
      trace_sphere({.radius = 2.4, .entry = Entry::lambert, .albedos = {0.9}, .bins = 16}, {400'000, 73, 0});
  for (int bin : {4, 8, 12}) {
    const Estimate seen = band(Boundary::lambert_lambert, 1.3, -1 + bin / 8.0, -1 + (bin + 1) / 8.0);
    const Estimate all{exitance.scattered[0][static_cast<std::size_t>(bin)].value +
                           exitance.ballistic[static_cast<std::size_t>(bin)].value,
                       exitance.scattered[0][static_cast<std::size_t>(bin)].noise};
    EXPECT_NEAR(seen.value, all.value, 4 * std::hypot(seen.noise, all.noise) + 0.01 * all.value) << "bin " << bin;
  }
}

TEST(Picture, OfWhatCyclesSolvesAgreesWithAnotherMonteCarlo) {
  // Albedo .9, radius 2.4, at cosines -.9, .1, .9 to the light, camera at right angles to it; the width of their bands
  // is not known.
  struct Row {
    Boundary boundary;
    double eta, dark, side, lit;
  };
  for (const Row& row : {Row{Boundary::lambert_refracted, 1, .0134, .1416, .6355},
                         Row{Boundary::lambert_refracted, 1.3, .0231, .1410, .5042},
                         Row{Boundary::lambert_lambert, 1.3, .0359, .1502, .4711}}) {
    EXPECT_NEAR(band(row.boundary, row.eta, -1, -0.77).value, row.dark, 0.12 * row.dark);
    EXPECT_NEAR(band(row.boundary, row.eta, 0, 0.2).value, row.side, 0.03 * row.side);
    EXPECT_NEAR(band(row.boundary, row.eta, 0.77, 1).value, row.lit, 0.04 * row.lit);
  }
}

TEST(Picture, TravelsThroughAFileWithItsNoise) {
  nlohmann::json scene = thesis_scene(0.9, 0.1, 1.3, 1);
  scene["resolution"] = {7, 5};
  const io::SceneFile file = io::parse_scene(scene.dump(), "");
  PictureCase setup = picture_case(file);
  setup.samples = 16;
  const Picture picture = trace_picture(setup);
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "referee_picture.exr";
  write_picture(path, file, setup, picture);
  const io::ExrFile read = io::read_exr(path);
  std::filesystem::remove(path);
  ASSERT_EQ(read.channels.size(), 7u);
  EXPECT_EQ(read.image.width, 7);
  EXPECT_EQ(read.image.height, 5);
  const auto at = [&](const std::string& name) {
    return std::find(read.channels.begin(), read.channels.end(), name) - read.channels.begin();
  };
  const float* middle = read.image.view().at(3, 2);
  EXPECT_EQ(middle[at("G")], static_cast<float>(picture.radiance[2 * 7 + 3].y));
  EXPECT_EQ(middle[at("A")], 1);
  EXPECT_EQ(middle[at("noise.B")], static_cast<float>(picture.noise[2 * 7 + 3].z));
  EXPECT_EQ(read.attributes.at("mesograin:samples"), "16");
}

TEST(Picture, DoesNotDependOnTheNumberOfThreads) {
  PictureCase setup = parse(thesis_scene(0.9, 0.1, 1.3, 1));
  setup.samples = 4;
  setup.threads = 1;
  const Picture one = trace_picture(setup);
  setup.threads = 3;
  EXPECT_EQ(one.radiance, trace_picture(setup).radiance);
}

TEST(Picture, SaysWhatItCannotTrace) {
  const auto sentence = [](const char* where, const char* key, const nlohmann::json& value) -> std::string {
    nlohmann::json scene = thesis_scene(0.9, 0.1, 1.3, 1);
    scene[where][key] = value;
    try {
      trace_picture(parse(scene));
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(sentence("material", "roughness", 0.2), "The referee's sphere is smooth: roughness must be 0; got 0.2.");
  EXPECT_EQ(sentence("material", "g", 1), "The referee needs g inside (-1, 1); got 1.");
  EXPECT_EQ(sentence("camera", "position", {0, 0, 1}),
            "The camera must stand outside the sphere, its near plane too; move it away.");
}

}  // namespace
}  // namespace mesograin::referee

// Grains of models 2 and 3 as they are drawn, light maps and all, over random materials that reach every corner:
// finite, never negative, never more than came in, as exact far away as near.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "gl/context_thread.h"
#include "grain_pictures.h"
#include "io/scene_json.h"
#include "models/material_inputs.h"
#include "random_grains.h"

namespace mesograin::render {
namespace {

using io::to_json;
using scene::Boundary;
using scene::Material;
using scene::Model;

constexpr double pi = 3.14159265358979323846;
constexpr int size = 12;

// With MESOGRAIN_ALL_EXTREMES set, ten thousand random grains and every corner; else what takes about a minute.
bool all_extremes() { return std::getenv("MESOGRAIN_ALL_EXTREMES") != nullptr; }

#if defined(__SANITIZE_ADDRESS__)
constexpr int some = 10;
#else
constexpr int some = 60;
#endif

int grain_count() { return all_extremes() ? 10000 : some; }

void expect_finite(View& view, const Material& material, const scene::Setting& setting) {
  scene::Scene scene{{}, setting.lights};
  for (const double away : setting.away)
    scene.instances.push_back({sphere(), material, scene::placed(setting.radius, away)});
  view.set_scene(scene);
  view.set_taps(setting.taps);
  for (const scene::Instance& instance : scene.instances) {
    view.set_camera(camera_at(instance.object_to_world, glm::normalize(glm::dvec3(0.2, 0.4, 0.9))));
    for (const float value : draw(view))
      ASSERT_TRUE(std::isfinite(value) && value >= 0.0F)
          << value << " of " << to_json(material) << ", radius " << setting.radius << ", at "
          << glm::length(glm::dvec3(instance.object_to_world[3])) << ", " << setting.lights.size() << " lights, "
          << setting.taps << " taps";
  }
}

constexpr int grains_in_a_setting = 25;

TEST(Extremes, RandomGrainsAreFiniteAndNeverNegative) {
  scene::RandomGrains random(20240608);
  View view(size, size);
  scene::Setting setting;
  for (int i = 0; i < grain_count() && !::testing::Test::HasFailure(); ++i) {
    if (i % grains_in_a_setting == 0) setting = random.setting();
    expect_finite(view, random.material(), setting);
  }
  EXPECT_EQ(gl::ContextThread::instance().take_gl_errors(), std::vector<std::string>());
}

TEST(Extremes, CornersAreFiniteAndNeverNegative) {
  scene::RandomGrains random(20240609);
  View view(size, size);
  const std::vector<Material> corners = scene::corners();
  const std::size_t count = all_extremes() ? corners.size() : some;
  scene::Setting setting;
  for (std::size_t i = 0; i < count && !::testing::Test::HasFailure(); ++i) {
    if (i % grains_in_a_setting == 0) setting = random.setting();
    expect_finite(view, corners[i], setting);
  }
  EXPECT_EQ(gl::ContextThread::instance().take_gl_errors(), std::vector<std::string>());
}

// Also where no pixel of a small picture looks.
TEST(Extremes, TablesAndUniformsAreFinite) {
  scene::RandomGrains random(20240610);
  for (int i = 0; i < grain_count() && !::testing::Test::HasFailure(); ++i) {
    const Material material = random.material();
    const double radius = random.setting().radius;
    const models::MaterialInputs inputs = models::material_inputs(material, radius);
    const auto expect_finite = [&](const std::string& name, double value) {
      ASSERT_TRUE(std::isfinite(value)) << value << " in " << name << " of " << to_json(material) << ", radius "
                                        << radius;
    };
    for (const auto& [name, table] : inputs.tables)
      for (const glm::vec4& texel : table.texels)
        for (int channel = 0; channel < 4; ++channel) expect_finite(name, texel[channel]);
    for (const auto& [name, value] : inputs.uniforms)
      std::visit(
          [&, &uniform = name](const auto& number) {
            if constexpr (std::is_arithmetic_v<std::decay_t<decltype(number)>>)
              expect_finite(uniform, number);
            else
              for (int channel = 0; channel < number.length(); ++channel) expect_finite(uniform, number[channel]);
          },
          value);
  }
}

// The flux that a unit sphere sends in every direction, per flux that meets it: pictures from directions that integrate
// over the sphere of directions, the light along +y, about which everything is symmetric.
glm::dvec3 sent_back(View& view, const Material& material) {
  const double nodes[] = {-0.9602898564975363, -0.7966664774136267, -0.5255324099163290, -0.1834346424956498,
                          0.1834346424956498,  0.5255324099163290,  0.7966664774136267,  0.9602898564975363};
  const double weights[] = {0.1012285362903763, 0.2223810344533745, 0.3137066458778873, 0.3626837833783620,
                            0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
  const glm::dmat4 here(1.0);
  view.set_scene({{{sphere(), material, here}}, {scene::DirectionalLight{{0, 1, 0}, {1, 1, 1}}}});
  glm::dvec3 flux(0.0);
  for (int k = 0; k < 8; ++k) {
    view.set_camera(camera_at(here, {0.0, nodes[k], std::sqrt(1.0 - nodes[k] * nodes[k])}));
    const std::vector<float> pixels = draw(view, 2);
    for (std::size_t i = 0; i < pixels.size(); i += 4)
      for (int channel = 0; channel < 3; ++channel)
        flux[channel] += 2.0 * pi * weights[k] * pixels[i + static_cast<std::size_t>(channel)] * 4.0 /
                         static_cast<double>(view.width() * view.height());
  }
  return flux / pi;
}

TEST(Extremes, GrainsSendBackNoMoreThanCameIn) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "What the device draws is not instrumented, and what sends it is by the other tests here.";
#endif
  View view(24, 24);
  view.set_taps(64);
  for (const Model model : {Model::model_2, Model::model_3})
    for (const Boundary boundary : {Boundary::dielectric, Boundary::index_matched, Boundary::lambert_lambert})
      for (const double eta : {0.7, 1.3, 2.5})
        for (const double g : {0.0, 0.7})
          for (const double sigma_s : {2.0, 15.0}) {
            if (boundary != Boundary::dielectric && eta != 1.3) continue;
            Material material;
            material.model = model;
            material.boundary = boundary;
            material.eta = eta;
            material.g = g;
            material.specular = false;
            material.sigma_s = glm::dvec3(sigma_s);
            material.sigma_a = {0.0, 1e-3 * sigma_s, sigma_s};
            const glm::dvec3 back = sent_back(view, material);
            for (int channel = 0; channel < 3; ++channel)
              EXPECT_LE(back[channel], 1.03) << to_json(material) << " channel " << channel;
          }
}

TEST(Extremes, AGrainAKilometreAwayIsAsExactAsOneAtTheOrigin) {
  const glm::dvec3 away(1e6, -2e6, 3e6);  // a kilometre and more, in millimetres
  // What single precision leaves of a tenth of a millimetre there: nothing.
  EXPECT_GT(std::abs((static_cast<float>(away.z + 0.1) - static_cast<float>(away.z)) - 0.1F), 0.05F);
  for (const Model model : {Model::model_2, Model::model_3}) {
    Material material;
    material.model = model;
    material.sigma_s = glm::dvec3(6.0);
    std::vector<float> pictures[2];
    for (const int place : {0, 1}) {
      const glm::dmat4 object_to_world =
          glm::scale(glm::translate(glm::dmat4(1.0), static_cast<double>(place) * away), glm::dvec3(0.5));
      View view(size, size);
      view.set_scene({{{sphere(), material, object_to_world}}, {scene::DirectionalLight{{0.3, 1.0, 0.5}, {1, 1, 1}}}});
      view.set_camera(camera_at(object_to_world, {0.0, 0.0, 1.0}));
      pictures[place] = draw(view);
    }
    for (std::size_t i = 0; i < pictures[0].size(); ++i) EXPECT_NEAR(pictures[1][i], pictures[0][i], 1e-4F);
  }
}

}  // namespace
}  // namespace mesograin::render

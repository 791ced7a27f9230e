// Grains of models 2 and 3 as they are drawn, light maps and all, over random materials that reach every corner:
// finite, never negative, never more than came in, and without a jump where another branch takes over.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "gl/context_thread.h"
#include "render/view.h"
#include "scene/scene_json.h"
#include "scene/sphere.h"

namespace mesograin::render {
namespace {

using scene::Boundary;
using scene::Masking;
using scene::Material;
using scene::Model;
using scene::Profile;

constexpr double pi = 3.14159265358979323846;
constexpr int size = 12;

class RandomGrains {
 public:
  explicit RandomGrains(unsigned seed) : random_(seed) {}

  Material material() {
    Material material;
    material.model = pick({Model::model_2, Model::model_3, Model::model_3});
    material.boundary = pick({Boundary::dielectric, Boundary::dielectric, Boundary::index_matched,
                              Boundary::lambert_lambert, Boundary::lambert_refracted});
    material.masking = pick({Masking::correlated, Masking::separable});
    material.profile = material.model == Model::model_2
                           ? pick({Profile::half_space, Profile::better_dipole, Profile::dipole})
                           : pick({Profile::half_space, Profile::better_dipole, Profile::dipole, Profile::photon_beam});
    // Every colour costs tables of its own; most grains here are grey.
    const bool grey = pick({true, true, true, true, false});
    for (int channel = 0; channel < 3; ++channel) {
      material.sigma_a[channel] = grey && channel > 0 ? material.sigma_a[0] : coefficient();
      material.sigma_s[channel] = grey && channel > 0 ? material.sigma_s[0] : coefficient();
    }
    material.g = pick({0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 1.0, 1e-9, even(-1.0, 1.0)});
    material.eta = pick({0.5, 1.0, 1.0 - 1e-7, 1.0 + 1e-7, 4.0, even(0.5, 4.0), even(1.0, 2.0), even(1.0, 2.0)});
    material.roughness = pick({0.0, 0.0, 1e-7, 1.0, even(0.0, 1.0)});
    material.specular = pick({true, false});
    material.scale = pick({1.0, 1.0, 0.0, 1e-6, 1e6});
    return material;
  }

  /// A sphere from a micrometre to a kilometre, up to a kilometre from the origin (in millimetres).
  glm::dmat4 object_to_world() {
    const double radius = pick({1.0, 1.0, 1e-3, 1e3, 1e6});
    const double away = pick({0.0, 1.0, 1e3, 1e6});
    return glm::scale(glm::translate(glm::dmat4(1.0), away * glm::dvec3(0.3, -1.0, 0.6)), glm::dvec3(radius));
  }

  std::vector<scene::DirectionalLight> lights() {
    std::vector<scene::DirectionalLight> lights;
    for (int i = pick({1, 1, 2, 5}); i > 0; --i)
      lights.push_back(
          {{even(-1.0, 1.0), even(-1.0, 1.0), even(0.1, 1.0)}, glm::dvec3(1.0), pick({0.0, 0.0, 0.01, 3.0})});
    return lights;
  }

  int taps() { return pick({1, 4, 16}); }

 private:
  template <typename Value>
  Value pick(std::initializer_list<Value> values) {
    return values.begin()[std::uniform_int_distribution<std::size_t>(0, values.size() - 1)(random_)];
  }
  double even(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
  double coefficient() { return pick({0.0, 1e12, magnitude(6.0), magnitude(6.0), magnitude(1.5), magnitude(1.5)}); }
  double magnitude(double decades) { return std::pow(10.0, even(-decades, decades)); }

  std::mt19937 random_;
};

scene::MeshPointer sphere() {
  static const scene::MeshPointer mesh = std::make_shared<const scene::Mesh>(scene::unit_sphere(24, 12));
  return mesh;
}

// From `direction`, filling the picture with the sphere that the transform makes of the unit sphere.
scene::Camera camera_at(const glm::dmat4& object_to_world, const glm::dvec3& direction) {
  const glm::dvec3 centre(object_to_world[3]);
  const double radius = object_to_world[0][0];
  const glm::dvec3 up = std::abs(direction.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  return {glm::lookAt(centre + 4.0 * radius * direction, centre, up),
          glm::ortho(-radius, radius, -radius, radius, radius, 7.0 * radius)};
}

std::vector<float> draw(View& view, int samples = 1) {
  view.render(samples);
  std::vector<float> pixels(static_cast<std::size_t>(view.width()) * static_cast<std::size_t>(view.height()) * 4);
  view.read(pixels.data());
  return pixels;
}

#if defined(__SANITIZE_ADDRESS__)
constexpr int grain_count = 20;
#else
constexpr int grain_count = 100;
#endif

TEST(Extremes, GrainsAreFiniteAndNeverNegative) {
  RandomGrains random(20240608);
  View view(size, size);
  for (int i = 0; i < grain_count && !::testing::Test::HasFailure(); ++i) {
    const Material material = random.material();
    const glm::dmat4 object_to_world = random.object_to_world();
    const scene::Scene scene{{{sphere(), material, object_to_world}}, random.lights()};
    view.set_scene(scene);
    view.set_camera(camera_at(object_to_world, glm::normalize(glm::dvec3(0.2, 0.4, 0.9))));
    view.set_taps(random.taps());
    for (const float value : draw(view))
      ASSERT_TRUE(std::isfinite(value) && value >= 0.0F)
          << value << " of " << to_json(material) << ", radius " << object_to_world[0][0] << ", " << scene.lights.size()
          << " lights, grain " << i;
  }
  EXPECT_EQ(gl::ContextThread::instance().take_gl_errors(), std::vector<std::string>());
}

// The flux that a unit sphere sends in every direction, per flux that meets it: pictures from directions that integrate
// over the sphere of directions, the light along +y, about which everything is symmetric.
glm::dvec3 sent_back(View& view, const Material& material) {
  const double nodes[] = {-0.9602898564975363, -0.7966664774136267, -0.5255324099163290, -0.1834346424956498,
                          0.1834346424956498,  0.5255324099163290,  0.7966664774136267,  0.9602898564975363};
  const double weights[] = {0.1012285362903763, 0.2223810344533745, 0.3137066458778873, 0.3626837833783620,
                            0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
  const glm::dmat4 here(1.0);
  view.set_scene({{{sphere(), material, here}}, {{{0, 1, 0}, {1, 1, 1}}}});
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
      view.set_scene({{{sphere(), material, object_to_world}}, {{{0.3, 1.0, 0.5}, {1, 1, 1}}}});
      view.set_camera(camera_at(object_to_world, {0.0, 0.0, 1.0}));
      pictures[place] = draw(view);
    }
    for (std::size_t i = 0; i < pictures[0].size(); ++i) EXPECT_NEAR(pictures[1][i], pictures[0][i], 1e-4F);
  }
}

class Continuity : public testing::TestWithParam<Model> {
 protected:
  std::vector<float> picture(const Material& material) {
    const glm::dmat4 here(1.0);
    view_.set_scene({{{sphere(), material, here}}, {{{0.3, 1.0, 0.5}, {1, 1, 1}}}});
    view_.set_camera(camera_at(here, {0.0, 0.0, 1.0}));
    return draw(view_);
  }

  // The difference of two pictures over their light. (Single pixels at the silhouette see the light map's texels.)
  static double step(const std::vector<float>& one, const std::vector<float>& other) {
    double difference = 0.0;
    double light = 1e-2;  // what is darker than this is black
    for (std::size_t i = 0; i < one.size(); ++i) {
      if (i % 4 == 3) continue;
      difference += std::abs(one[i] - other[i]);
      light += std::max(one[i], other[i]);
    }
    return difference / light;
  }

  template <typename Change>
  void expect_alike(const Material& material, Change change, double tolerance) {
    Material changed = material;
    change(changed);
    EXPECT_LE(step(picture(material), picture(changed)), tolerance) << to_json(material) << "\nagainst\n"
                                                                    << to_json(changed);
  }

  void SetUp() override { view_.set_taps(64); }

  View view_{size, size};
};

TEST_P(Continuity, NothingJumpsWhereABranchTakesOver) {
  for (const Profile profile : {Profile::half_space, Profile::better_dipole})
    for (const Boundary boundary : {Boundary::dielectric, Boundary::lambert_lambert})
      for (const double sigma_a : {0.0, 0.3}) {
        Material material;
        material.model = GetParam();
        material.profile = profile;
        material.boundary = boundary;
        material.specular = false;
        material.sigma_s = glm::dvec3(2.0);
        material.sigma_a = glm::dvec3(sigma_a);
        expect_alike(
            material, [](Material& m) { m.g = 1e-7; }, 3e-2);
        expect_alike(
            material, [](Material& m) { m.g = -1e-7; }, 3e-2);
        expect_alike(
            material, [](Material& m) { m.sigma_a += glm::dvec3(1e-9); }, 1e-3);
        expect_alike(
            material, [](Material& m) { m.roughness = 1e-6; }, 5e-3);
        Material matched = material;
        matched.eta = 1.0;
        expect_alike(
            matched, [](Material& m) { m.eta = 1.0 + 1e-7; }, 1e-2);
        expect_alike(
            matched, [](Material& m) { m.eta = 1.0 - 1e-7; }, 1e-2);
        Material clear = material;
        clear.sigma_s = glm::dvec3(0.0);
        expect_alike(
            clear, [](Material& m) { m.sigma_s = glm::dvec3(1e-9); }, 1e-2);
      }
}

// From a translucent grain to an opaque one in steps of a quarter: no step may change a picture by much more than that.
TEST_P(Continuity, NothingJumpsFromTranslucentToOpaque) {
  for (const double sigma_a : {0.0, 0.5})
    for (const Boundary boundary : {Boundary::dielectric}) {
      Material material;
      material.model = GetParam();
      material.boundary = boundary;
      material.sigma_s = glm::dvec3(1.0);
      material.sigma_a = glm::dvec3(sigma_a);
      material.scale = 0.5;
      std::vector<float> before = picture(material);
      while (material.scale < 100.0) {
        material.scale *= 1.25;
        const std::vector<float> now = picture(material);
        EXPECT_LE(step(before, now), 0.25) << to_json(material);
        before = now;
      }
    }
}

INSTANTIATE_TEST_SUITE_P(Models, Continuity, testing::Values(Model::model_2, Model::model_3), [](const auto& info) {
  return std::string(scene::model_names[static_cast<std::size_t>(info.param)]);
});

}  // namespace
}  // namespace mesograin::render

// Grains of models 2 and 3 without a jump where another branch takes over, in every parameter over its whole range.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "grain_pictures.h"
#include "io/scene_json.h"

namespace mesograin::render {
namespace {

using io::to_json;
using scene::Boundary;
using scene::Material;
using scene::Model;
using scene::Profile;

constexpr int size = 12;

// A parameter over its whole range. `largest`: what one step may change; what stands out most from its neighbours is
// halved until a change that stays can only be a jump.
struct Sweep {
  const char* name;
  std::vector<double> values;
  void (*set)(Material&, double);
  double largest;
};

std::vector<double> spaced(double first, double last, int count, bool geometric) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    const double share = i / (count - 1.0);
    values.push_back(geometric ? first * std::pow(last / first, share) : first + share * (last - first));
  }
  return values;
}

class Continuity : public testing::TestWithParam<Model> {
 protected:
  std::vector<float> picture(const Material& material) {
    const glm::dmat4 here(1.0);
    view_.set_scene({{{sphere(), material, here}}, {scene::DirectionalLight{{0.3, 1.0, 0.5}, {1, 1, 1}}}});
    view_.set_camera(camera_at(here, {0.0, 0.0, 1.0}));
    return draw(view_);
  }

  // The difference of two pictures over their light. (Single pixels at the silhouette see the light map's texels.)
  static double step(const std::vector<float>& one, const std::vector<float>& other) {
    double difference = 0.0;
    double light = 0.4;  // a mean radiance of a thousandth is black
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

  // What `name` says changes too much at once, or by a jump.
  void expect_no_jump(const Sweep& sweep, Profile profile, Boundary boundary) {
    Material material;
    material.model = GetParam();
    material.profile = profile;
    material.boundary = boundary;
    material.specular = false;
    const auto at = [&](double value) {
      sweep.set(material, value);
      return picture(material);
    };
    std::vector<std::vector<float>> pictures;
    for (const double value : sweep.values) pictures.push_back(at(value));
    std::vector<double> changes(pictures.size() + 1, 0.0);  // with a still neighbour at either end
    for (std::size_t i = 1; i < pictures.size(); ++i) {
      changes[i] = step(pictures[i - 1], pictures[i]);
      EXPECT_LE(changes[i], sweep.largest)
          << sweep.name << " from " << sweep.values[i - 1] << " to " << sweep.values[i] << " of " << to_json(material);
    }
    std::size_t sharpest = 1;
    double most = -1.0;
    for (std::size_t i = 1; i < pictures.size(); ++i) {
      const double above = changes[i] - std::max(changes[i - 1], changes[i + 1]);
      if (above > most) {
        most = above;
        sharpest = i;
      }
    }
    double low = sweep.values[sharpest - 1];
    double high = sweep.values[sharpest];
    // Drawn anew: the thickest of the sweep's grains left a finer light map, which serves all that follow.
    std::vector<float> before = at(low);
    std::vector<float> after = at(high);
    // Where light begins to enter a rarer grain it begins like a square root: half as much takes a quarter of the step.
    for (int halving = 0; halving < 14; ++halving) {
      const double middle = 0.5 * (low + high);
      std::vector<float> between = at(middle);
      if (step(before, between) > step(between, after)) {
        high = middle;
        after = std::move(between);
      } else {
        low = middle;
        before = std::move(between);
      }
    }
    EXPECT_LE(step(before, after), 0.02) << sweep.name << " at " << low << " of " << to_json(material);
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
            material, [](Material& m) { m.g = 1e-17; }, 5e-4);
        expect_alike(
            material, [](Material& m) { m.g = 1e-6; }, 5e-4);
        expect_alike(
            material, [](Material& m) { m.g = -1e-6; }, 5e-4);
        expect_alike(
            material, [](Material& m) { m.g = 1e-3; }, 5e-3);
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

TEST_P(Continuity, NothingJumpsInAnyParameterOverItsWholeRange) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "A thousand materials take minutes here, and run no code that the other tests do not.";
#endif
  // What is scattered twice falls with the square of the scale; a step here is by a factor of 1.78.
  const double twice = 1.0 - 1.0 / (1.78 * 1.78);
  // From g = 0.85 to 0.95 the phase function at right angles, where these pictures are taken, falls by this much.
  const double sideways = 0.7;
  const Sweep sweeps[] = {
      {"scale", spaced(1e-6, 1e6, 49, true), [](Material& m, double value) { m.scale = value; }, twice},
      {"sigma_a", spaced(1e-6, 1e6, 49, true), [](Material& m, double value) { m.sigma_a = glm::dvec3(value); }, twice},
      {"eta", spaced(0.5, 4.0, 36, false), [](Material& m, double value) { m.eta = value; }, 0.6},
      {"roughness", spaced(0.0, 1.0, 11, false), [](Material& m, double value) { m.roughness = value; }, 0.05},
      {"g", spaced(-0.95, 0.95, 20, false), [](Material& m, double value) { m.g = value; }, sideways}};
  struct Theory {
    Profile profile;
    Boundary boundary;
  };
  for (const auto& [profile, boundary] :
       {Theory{Profile::half_space, Boundary::dielectric}, Theory{Profile::better_dipole, Boundary::dielectric},
        Theory{Profile::half_space, Boundary::lambert_lambert}, Theory{Profile::photon_beam, Boundary::index_matched}})
    for (const Sweep& sweep : sweeps) {
      if (GetParam() == Model::model_2 && profile == Profile::photon_beam) continue;
      const bool interface = sweep.set == sweeps[2].set || sweep.set == sweeps[3].set;
      if (interface && boundary != Boundary::dielectric) continue;
      expect_no_jump(sweep, profile, boundary);
    }
}

// Beyond a thousand mean free paths a grain is opaque, and thicker changes nothing: also where the mean free path is
// far below a texel of the light map and a facet of the mesh.
TEST_P(Continuity, AnOpaqueGrainStaysAsItIs) {
  for (const double sigma_a : {0.0, 0.5})
    for (const Boundary boundary : {Boundary::dielectric, Boundary::lambert_lambert}) {
      Material material;
      material.model = GetParam();
      material.boundary = boundary;
      material.specular = false;
      material.sigma_s = glm::dvec3(1.0);
      material.sigma_a = glm::dvec3(sigma_a);
      material.scale = 1e3;
      const std::vector<float> opaque = picture(material);
      for (; material.scale <= 1e6; material.scale *= 10.0)
        EXPECT_LE(step(opaque, picture(material)), 0.03) << to_json(material);
    }
}

// What is not scattered crosses: under a sky that is the same all around a grain that absorbs nothing is not to be
// seen, however little or much of the light is scattered, and one that scatters next to nothing looks as one that
// scatters nothing.
TEST_P(Continuity, AGrainThatScattersNothingIsGlass) {
  scene::World sky;
  sky.radiance = glm::dvec3(1.0);
  constexpr int many = 16;  // in one sample model 3 has the light of a single direction
#if defined(__SANITIZE_ADDRESS__)
  constexpr int some = 4;
  const std::vector<double> scatterings = {0.01};  // each takes many seconds here, and all run the same code
#else
  constexpr int some = many;
  const std::vector<double> scatterings = {1e-6, 1e-4, 0.01, 1.0, 8.0};
#endif
  const auto under_the_sky = [&](const Material& material, int samples) {
    const glm::dmat4 here(1.0);
    view_.set_scene({{{sphere(), material, here}}, {}, sky});
    view_.set_camera(camera_at(here, {0.0, 0.0, 1.0}));
    return draw(view_, samples);
  };
  const auto mean = [](const std::vector<float>& pixels) {
    double sum = 0.0;
    double covered = 0.0;
    for (std::size_t i = 0; i < pixels.size(); i += 4) {
      sum += pixels[i];
      covered += pixels[i + 3];
    }
    return sum / covered;
  };
  for (const Boundary boundary : {Boundary::dielectric, Boundary::index_matched}) {
    Material material;
    material.model = GetParam();
    material.boundary = boundary;
    material.specular = boundary == Boundary::dielectric;
    material.sigma_s = glm::dvec3(0.0);
    material.sigma_a = glm::dvec3(0.0);
    const std::vector<float> glass = under_the_sky(material, many);
    EXPECT_NEAR(mean(glass), 1.0, 0.01) << to_json(material);
    for (const double sigma_s : scatterings) {
      material.sigma_s = glm::dvec3(sigma_s);
      const std::vector<float> near = under_the_sky(material, some);
      EXPECT_NEAR(mean(near), 1.0, 0.04) << to_json(material);
      EXPECT_LE(step(glass, near), 10.0 * sigma_s) << to_json(material);
    }
    // Through an absorbing ball the world is seen as far as its chords say: all in the middle, where they are longest.
    material.sigma_s = glm::dvec3(0.0);
    material.specular = false;
    const std::vector<float> colourless = under_the_sky(material, some);
    material.sigma_a = glm::dvec3(0.5, 1.0, 2.0);
    const std::vector<float> coloured = under_the_sky(material, some);
    constexpr std::size_t middle = 4 * (size / 2 * size + size / 2);
    for (std::size_t channel = 0; channel < 3; ++channel)
      EXPECT_NEAR(std::log(colourless[middle + channel] / coloured[middle + channel]),
                  2.0 * material.sigma_a[static_cast<int>(channel)], 0.1)
          << to_json(material);
  }
}

INSTANTIATE_TEST_SUITE_P(Models, Continuity, testing::Values(Model::model_2, Model::model_3), [](const auto& info) {
  return std::string(scene::model_names[static_cast<std::size_t>(info.param)]);
});

}  // namespace
}  // namespace mesograin::render

// The models as the GPU evaluates them, over random materials that reach every corner: finite, never negative, never
// more than came in, the same both ways, without a jump where another branch takes over.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "base/error.h"
#include "gl/buffer.h"
#include "gl/context_thread.h"
#include "gl/program.h"
#include "gl/shader_source.h"
#include "gl/texture.h"
#include "models/material_inputs.h"
#include "physics/half_space/dielectric_surface.h"
#include "physics/physics.h"
#include "physics/quadrature.h"

namespace mesograin::physics {
namespace {

using models::material_inputs;
using models::MaterialInputs;
using models::UniformValue;
using scene::Boundary;
using scene::Masking;
using scene::Material;
using scene::Model;
using scene::Profile;

struct Directions {
  glm::vec4 to_light;
  glm::vec4 to_viewer;
};

const glm::dvec3 normal = glm::normalize(glm::dvec3(0.2, -0.5, 0.7));

glm::vec4 direction(double mu, double azimuth) {
  const glm::dvec3 tangent = glm::normalize(glm::cross(normal, glm::dvec3(1.0, 0.0, 0.0)));
  const glm::dvec3 bitangent = glm::cross(normal, tangent);
  const double sine = std::sqrt(std::max(0.0, 1.0 - mu * mu));
  return glm::vec4(glm::vec3(sine * std::cos(azimuth) * tangent + sine * std::sin(azimuth) * bitangent + mu * normal),
                   0.0F);
}

// Evaluates models for lists of directions, with unit irradiance; keeps one program for each set of choices.
class Evaluator {
 public:
  std::vector<glm::vec4> operator()(const Material& material, const std::vector<Directions>& directions) {
    const MaterialInputs inputs = material_inputs(material);
    return gl::ContextThread::instance().run([&] {
      const gl::Program& program = program_for(material.model, inputs.defines);
      std::map<std::string, gl::Texture> textures;
      for (const auto& [name, table] : inputs.tables) {
        gl::Texture texture(GL_RGBA32F, table.width, table.height);
        texture.upload(GL_RGBA, GL_FLOAT, table.texels.data());
        texture.sample_linearly(true);
        textures.emplace(name, std::move(texture));
      }
      program.use();
      program.set("normal", glm::vec3(normal));
      for (const auto& [name, value] : inputs.uniforms)
        std::visit([&, &uniform = name](const auto& number) { program.set(uniform, number); }, value);
      for (const auto& [name, texture] : textures) program.set(name, texture);
      const gl::Buffer input(directions);
      std::vector<glm::vec4> radiance(directions.size());
      const gl::Buffer output(radiance);
      input.bind_storage(0);
      output.bind_storage(1);
      glDispatchCompute(static_cast<GLuint>((directions.size() + 63) / 64), 1, 1);
      output.read(radiance.data(), radiance.size() * sizeof(glm::vec4));
      return radiance;
    });
  }

  ~Evaluator() {
    gl::ContextThread::instance().run([this] { programs_.clear(); });
  }

 private:
  const gl::Program& program_for(Model model, const std::vector<std::string>& defines) {
    const std::string name(scene::model_names[static_cast<std::size_t>(model)]);
    std::string key = name;
    for (const std::string& define : defines) key += " " + define;
    const auto found = programs_.find(key);
    if (found != programs_.end()) return found->second;
    const std::string text =
        "#include \"models/" + name +
        ".glsl\"\n"
        "layout(local_size_x = 64) in;\n"
        "layout(std430, binding = 0) readonly buffer Inputs { vec4 directions[]; };\n"
        "layout(std430, binding = 1) writeonly buffer Outputs { vec4 radiance[]; };\n"
        "uniform vec3 normal;\n"
        "void main() {\n"
        "  uint index = gl_GlobalInvocationID.x;\n"
        "  if (index >= radiance.length()) return;\n"
        "  SurfacePoint point = SurfacePoint(vec3(0.0), normal, directions[2u * index + 1u].xyz, vec3(0.0));\n"
        "  radiance[index] = vec4(evaluate_model(point, look_outwards(point), parallel_light(directions[2u * "
        "index].xyz, "
        "vec3(1.0), 0, 0.0, 0, 0.0)), "
        "1.0);\n"
        "}\n";
    return programs_.emplace(key, gl::Program(key, gl::ShaderSource::from_text(key + ".comp", text, defines)))
        .first->second;
  }

  std::map<std::string, gl::Program> programs_;
};

// White furnace: a few lights, and for each the hemisphere of views by quadrature; behind them come directions at every
// extreme.
struct Furnace {
  std::vector<double> light_cosines{0.1, 0.3, 0.6, 0.9, 1.0};
  std::vector<Directions> directions;
  std::vector<double> weights;  // of the first light_cosines.size() * views directions
  std::size_t views = 0;

  // A grain rarer than what is around it lets nothing in beyond the critical angle, where its transmittance starts like
  // a square root.
  explicit Furnace(const Material& material) {
    // Over half a turn: every model here is symmetric about the plane of incidence; most know no azimuth at all.
    const bool reflects = material.specular && material.model == Model::model_1 && has_dielectric_surface(material);
    const int azimuths = material.model == Model::conductor || reflects || material.g != 0.0 ? 32 : 2;
    const bool refracts = material.model == Model::model_1 && material.boundary == Boundary::dielectric;
    const double eta = refracts ? std::min(material.eta, 1.0) : 1.0;
    for (const double mu_i : light_cosines)
      for (const QuadratureNode& node : gauss_legendre(24))
        for (int step = 0; step < azimuths; ++step) {
          const double inside = node.x * node.x;
          const double mu_o = refracted_cosine(inside, 1.0 / eta);
          directions.push_back({direction(mu_i, 0.0), direction(mu_o, PI * (step + 0.5) / azimuths)});
          weights.push_back(2.0 * node.x * node.weight * 2.0 * PI / azimuths * inside * eta * eta);
        }
    views = weights.size() / light_cosines.size();
    const double extremes[] = {-1.0, -0.5, 0.0, 1e-30, 1e-12, 1e-7, 1e-4, 0.5, 1.0 - 1e-7, 1.0};
    for (const double mu_i : extremes)
      for (const double mu_o : extremes)
        for (const double azimuth : {0.0, 1.0, PI})
          directions.push_back({direction(mu_i, 0.0), direction(mu_o, azimuth)});
  }

  // The largest part of the light that any channel sends back, over the lights.
  double largest_albedo(const std::vector<glm::vec4>& radiance) const {
    double largest = 0.0;
    for (std::size_t light = 0; light < light_cosines.size(); ++light) {
      glm::dvec3 exitance(0.0);
      for (std::size_t view = light * views; view < (light + 1) * views; ++view)
        exitance += weights[view] * glm::dvec3(glm::vec3(radiance[view]));
      for (int channel = 0; channel < 3; ++channel)
        largest = std::max(largest, exitance[channel] / light_cosines[light]);
    }
    return largest;
  }
};

class RandomMaterials {
 public:
  explicit RandomMaterials(unsigned seed) : random_(seed) {}

  Material next() {
    Material material;
    material.model =
        pick({Model::lambert, Model::conductor, Model::model_1, Model::model_1, Model::model_1, Model::model_1});
    material.boundary = pick({Boundary::dielectric, Boundary::dielectric, Boundary::index_matched,
                              Boundary::lambert_lambert, Boundary::lambert_refracted});
    material.masking = pick({Masking::correlated, Masking::separable});
    material.profile = pick({Profile::half_space, Profile::half_space, Profile::better_dipole, Profile::dipole});
    for (int channel = 0; channel < 3; ++channel) {
      material.reflectance[channel] = pick({0.0, 1.0, even(0.0, 1.0), even(0.0, 1.0)});
      material.sigma_a[channel] = pick({0.0, 1e12, magnitude(), magnitude(), magnitude(), magnitude()});
      material.sigma_s[channel] = pick({0.0, 1e12, magnitude(), magnitude(), magnitude(), magnitude()});
    }
    // Anisotropy costs a hundred times what isotropy does.
    material.g = pick({0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, pick({-1.0, 1.0, 1e-9, even(-1.0, 1.0), even(-1.0, 1.0)})});
    material.eta =
        pick({0.5, 1.0, 1.0 - 1e-7, 1.0 + 1e-7, 4.0, even(0.5, 4.0), even(0.5, 4.0), even(1.0, 2.0), even(1.0, 2.0)});
    material.roughness = pick({0.0, 1e-7, 1.0, even(0.0, 1.0), even(0.0, 1.0)});
    material.specular = pick({true, false, false, false});
    material.scale = pick({1.0, 1.0, 1.0, 0.0, 1e-6, 1e6, magnitude()});
    return material;
  }

 private:
  template <typename Value>
  Value pick(std::initializer_list<Value> values) {
    return values.begin()[std::uniform_int_distribution<std::size_t>(0, values.size() - 1)(random_)];
  }
  double even(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
  double magnitude() { return std::pow(10.0, even(-9.0, 9.0)); }

  std::mt19937 random_;
};

std::string describe(const Material& m) {
  return fmt::format(
      "{} {} {} roughness {} specular {} reflectance {} {} {} sigma_a {} {} {} sigma_s {} {} {} g {} eta {} scale {}",
      scene::model_names[static_cast<std::size_t>(m.model)],
      scene::boundary_names[static_cast<std::size_t>(m.boundary)],
      scene::profile_names[static_cast<std::size_t>(m.profile)], m.roughness, m.specular, m.reflectance.r,
      m.reflectance.g, m.reflectance.b, m.sigma_a.r, m.sigma_a.g, m.sigma_a.b, m.sigma_s.r, m.sigma_s.g, m.sigma_s.b,
      m.g, m.eta, m.scale);
}

// What theory allows a material to send back.
double largest_albedo_allowed(const Material& material) {
  constexpr double rounding = 1e-4;
  if (material.model == Model::lambert) return 1.0 + rounding;
  // Narrower highlights slip between the directions of this furnace; ggx_test.cpp integrates those over half vectors.
  if (material.model == Model::conductor) return material.roughness >= 0.4 ? 1.01 : INFINITY;
  if (material.specular && has_dielectric_surface(material) && material.roughness < 0.4) return INFINITY;
  // The better dipole's higher orders reach 1 without absorption, and single scattering comes on top: up to a half at
  // grazing.
  const bool interface = material.boundary == Boundary::dielectric || material.boundary == Boundary::index_matched;
  if (interface && material.profile == Profile::better_dipole) return 1.5;
  // A rough surface is balanced for the half-space's light; the dipole's leaves a little differently.
  if (material.profile == Profile::dipole && has_rough_surface(material)) return 1.02;
  return 1.005;
}

#if defined(__SANITIZE_ADDRESS__)
constexpr int material_count = 500;  // an order of magnitude slower
#else
constexpr int material_count = 5000;
#endif

TEST(Models, SendBackFiniteLightAndNoMoreThanCameIn) {
  Evaluator evaluate;
  RandomMaterials materials(20240607);
  for (int i = 0; i < material_count && !::testing::Test::HasFailure(); ++i) {
    const Material material = materials.next();
    const Furnace furnace(material);
    const std::vector<glm::vec4> radiance = evaluate(material, furnace.directions);
    for (std::size_t k = 0; k < radiance.size(); ++k)
      for (int channel = 0; channel < 3; ++channel) {
        const float value = radiance[k][channel];
        ASSERT_TRUE(std::isfinite(value) && value >= 0.0F)
            << value << " of " << describe(material) << " at cosines "
            << glm::dot(normal, glm::dvec3(furnace.directions[k].to_light)) << " "
            << glm::dot(normal, glm::dvec3(furnace.directions[k].to_viewer));
      }
    EXPECT_LE(furnace.largest_albedo(radiance), largest_albedo_allowed(material)) << describe(material);
  }
  EXPECT_EQ(gl::ContextThread::instance().take_gl_errors(), std::vector<std::string>());
}

// Pairs of directions and the same pairs swapped.
std::vector<Directions> swapped(std::vector<Directions> directions) {
  for (Directions& pair : directions) std::swap(pair.to_light, pair.to_viewer);
  return directions;
}

std::vector<Directions> some_directions() {
  std::vector<Directions> directions;
  for (const double mu_i : {0.05, 0.3, 0.7, 1.0})
    for (const double mu_o : {0.1, 0.45, 0.95})
      for (const double azimuth : {0.0, 0.8, 2.0, PI})
        directions.push_back({direction(mu_i, 0.3), direction(mu_o, 0.3 + azimuth)});
  return directions;
}

TEST(Models, AreReciprocalWhereTheoryIs) {
  Evaluator evaluate;
  RandomMaterials materials(7);
  const std::vector<Directions> forth = some_directions();
  const std::vector<Directions> back = swapped(forth);
  for (int i = 0; i < 300; ++i) {
    Material material = materials.next();
    // The refracted view is a cosine lobe one way and a refraction the other: not reciprocal, as in the renderer that
    // it matches.
    if (material.boundary == Boundary::lambert_refracted) continue;
    const std::vector<glm::vec4> there = evaluate(material, forth);
    const std::vector<glm::vec4> here = evaluate(material, back);
    for (std::size_t k = 0; k < forth.size(); ++k)
      for (int channel = 0; channel < 3; ++channel) {
        const double mu_i = glm::dot(normal, glm::dvec3(forth[k].to_light));
        const double mu_o = glm::dot(normal, glm::dvec3(forth[k].to_viewer));
        const double a = there[k][channel] / mu_i;
        const double b = here[k][channel] / mu_o;
        EXPECT_NEAR(a, b, 3e-4 * std::max(a, b) + 1e-7) << describe(material);
      }
  }
}

// Two materials on either side of a branch must look alike.
void expect_alike(Evaluator& evaluate, const Material& one, const Material& other, double tolerance) {
  const std::vector<Directions> directions = some_directions();
  const std::vector<glm::vec4> a = evaluate(one, directions);
  const std::vector<glm::vec4> b = evaluate(other, directions);
  for (std::size_t k = 0; k < directions.size(); ++k)
    for (int channel = 0; channel < 3; ++channel)
      ASSERT_NEAR(a[k][channel], b[k][channel], tolerance * std::max(1e-3F, std::max(a[k][channel], b[k][channel])))
          << describe(one) << "\nagainst\n"
          << describe(other) << "\nat cosines " << glm::dot(normal, glm::dvec3(directions[k].to_light)) << " "
          << glm::dot(normal, glm::dvec3(directions[k].to_viewer));
}

TEST(Models, DoNotJumpWhereABranchTakesOver) {
  Evaluator evaluate;
  for (const Profile profile : {Profile::half_space, Profile::better_dipole, Profile::dipole})
    for (const Boundary boundary :
         {Boundary::dielectric, Boundary::index_matched, Boundary::lambert_lambert, Boundary::lambert_refracted})
      for (const double sigma_a : {0.0, 0.02, 5.0}) {
        Material material;
        material.model = Model::model_1;
        material.profile = profile;
        material.boundary = boundary;
        material.sigma_a = glm::dvec3(sigma_a);
        const auto with = [&](auto change) {
          Material changed = material;
          change(changed);
          return changed;
        };
        // anisotropy: isotropic scattering rides in the table, anything else is evaluated
        expect_alike(evaluate, material, with([](Material& m) { m.g = 1e-7; }), 2e-3);
        expect_alike(evaluate, material, with([](Material& m) { m.g = -1e-7; }), 2e-3);
        // beyond the largest anisotropy the similar medium answers
        expect_alike(evaluate, with([](Material& m) { m.g = 0.9 - 1e-7; }), with([](Material& m) { m.g = 0.9 + 1e-7; }),
                     1e-3);
        // no interface, and one that is hardly there
        expect_alike(evaluate, with([](Material& m) { m.eta = 1.0; }), with([](Material& m) { m.eta = 1.0 + 1e-7; }),
                     5e-3);
        expect_alike(evaluate, with([](Material& m) { m.eta = 1.0; }), with([](Material& m) { m.eta = 1.0 - 1e-7; }),
                     5e-3);
        // hardly any absorption, hardly any scattering, a smooth and a hardly rough view
        expect_alike(evaluate, with([](Material& m) { m.sigma_a = glm::dvec3(0.0); }),
                     with([](Material& m) { m.sigma_a = glm::dvec3(1e-9); }), 2e-3);
        expect_alike(evaluate, with([](Material& m) {
                       m.sigma_s = glm::dvec3(0.0);
                       m.sigma_a = glm::dvec3(1.0);
                     }),
                     with([](Material& m) {
                       m.sigma_s = glm::dvec3(1e-9);
                       m.sigma_a = glm::dvec3(1.0);
                     }),
                     1e-3);
        // (of what has entered: no light without extent is seen in a mirror, and any roughness is not quite one)
        expect_alike(evaluate, with([](Material& m) { m.specular = false; }), with([](Material& m) {
                       m.specular = false;
                       m.roughness = 1e-6;
                     }),
                     2e-3);
        // only the ratio of the coefficients counts
        expect_alike(evaluate, material, with([](Material& m) { m.scale = 1e6; }), 1e-6);
      }
}

TEST(Models, Model1SumsSingleAndMultipleScatteringToTheExactHalfSpace) {
  // With HG single scattering in closed form and the rest in a table, the albedo is the solver's, whatever the
  // anisotropy.
  Evaluator evaluate;
  for (const double g : {-0.9, -0.5, 0.0, 0.4, 0.9}) {
    Material conservative;
    conservative.model = Model::model_1;
    conservative.boundary = Boundary::index_matched;
    conservative.sigma_a = glm::dvec3(0.0);
    conservative.g = g;
    const Furnace furnace(conservative);
    EXPECT_NEAR(furnace.largest_albedo(evaluate(conservative, furnace.directions)), 1.0, 5e-3) << g;
  }
}

TEST(Models, RefuseWhatTheyCannotDraw) {
  Material material;
  material.model = Model::model_1;
  material.profile = Profile::photon_beam;
  EXPECT_THROW(material_inputs(material), Error);
  material.profile = Profile::half_space;
  material.sigma_a.g = std::nan("");
  EXPECT_THROW(material_inputs(material), Error);
}

}  // namespace
}  // namespace mesograin::physics

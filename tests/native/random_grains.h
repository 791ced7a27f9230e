// Random grains of models 2 and 3 that reach every corner, and the corners themselves.
#pragma once

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <initializer_list>
#include <random>
#include <vector>

#include "scene/scene.h"

namespace mesograin::scene {

/// How grains of a size are lit and sampled, and where they are (in millimetres from the origin): what many materials
/// are tried in, since light maps do not depend on them.
struct Setting {
  double radius;
  std::vector<double> away;
  std::vector<Light> lights;
  int taps;
};

/// A sphere `away` from the origin.
inline glm::dmat4 placed(double radius, double away) {
  return glm::scale(glm::translate(glm::dmat4(1.0), away * glm::dvec3(0.3, -1.0, 0.6)), glm::dvec3(radius));
}

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

  /// Radii from a micrometre to a kilometre, up to a kilometre from the origin.
  Setting setting() {
    return {pick({1.0, 1.0, 1e-3, 1e3, 1e6}), {0.0, pick({1.0, 1e3}), 1e6}, lights(), pick({1, 4, 16})};
  }

 private:
  template <typename Value>
  Value pick(std::initializer_list<Value> values) {
    return values.begin()[std::uniform_int_distribution<std::size_t>(0, values.size() - 1)(random_)];
  }
  double even(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
  double coefficient() { return pick({0.0, 1e12, magnitude(6.0), magnitude(6.0), magnitude(1.5), magnitude(1.5)}); }
  double magnitude(double decades) { return std::pow(10.0, even(-decades, decades)); }

  std::vector<Light> lights() {
    std::vector<Light> lights;
    for (int i = pick({1, 1, 2, 5}); i > 0; --i)
      lights.emplace_back(DirectionalLight{
          {even(-1.0, 1.0), even(-1.0, 1.0), even(0.1, 1.0)}, glm::dvec3(1.0), pick({0.0, 0.0, 0.01, 3.0})});
    return lights;
  }

  std::mt19937 random_;
};

/// Every combination of models 2 and 3, their profiles and boundaries, and the ends of every range that counts there.
/// Neighbours have little in common, so that the first few are a sample of all.
inline std::vector<Material> corners() {
  struct Coefficients {
    double sigma_a;
    double sigma_s;
  };
  std::vector<Material> ordered;
  for (const Model model : {Model::model_2, Model::model_3})
    for (const Profile profile : {Profile::half_space, Profile::better_dipole, Profile::dipole, Profile::photon_beam})
      for (const Boundary boundary :
           {Boundary::dielectric, Boundary::index_matched, Boundary::lambert_lambert, Boundary::lambert_refracted})
        for (const double g : {-1.0, 0.0, 1.0})
          for (const auto [sigma_a, sigma_s] :
               {Coefficients{0, 0}, Coefficients{0, 1}, Coefficients{1, 0}, Coefficients{1, 1}})
            for (const double scale : {1e-6, 1.0, 1e6})
              for (const double eta : {0.5, 1.0, 4.0})
                for (const double roughness : {0.0, 1.0}) {
                  if (model == Model::model_2 && profile == Profile::photon_beam) continue;
                  const bool interface = boundary == Boundary::dielectric || boundary == Boundary::lambert_refracted;
                  if (!interface && (eta != 1.0 || roughness != 0.0)) continue;
                  Material material;
                  material.model = model;
                  material.profile = profile;
                  material.boundary = boundary;
                  material.g = g;
                  material.sigma_a = glm::dvec3(sigma_a);
                  material.sigma_s = glm::dvec3(sigma_s);
                  material.scale = scale;
                  material.eta = eta;
                  material.roughness = roughness;
                  material.specular = ordered.size() % 3 != 0;
                  material.masking = ordered.size() % 2 == 0 ? Masking::correlated : Masking::separable;
                  ordered.push_back(material);
                }
  constexpr std::size_t stride = 1009;  // a prime that does not divide their number
  std::vector<Material> mixed;
  for (std::size_t i = 0; i < ordered.size(); ++i) mixed.push_back(ordered[i * stride % ordered.size()]);
  return mixed;
}

}  // namespace mesograin::scene

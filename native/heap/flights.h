// Free flights in a medium of three channels, and what they leave of the light. They are drawn for one channel and
// weighed for all three by the balance heuristic (Wilkie et al., "Hero wavelength spectral sampling", 2014, eq. 6), so
// that grey media have no noise in colour.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/vec3.hpp>

#include "transport/random.h"

namespace mesograin::heap {

/// Which channel chance goes by on a way of light, and how likely each would have gone it.
struct Hero {
  int channel = -1;         ///< none yet
  glm::vec3 density{1.0F};  ///< of each, over their mean: only their ratio counts

  void choose(transport::Random& random) {
    if (channel < 0) channel = std::min(static_cast<int>(3.0F * random.uniform()), 2);
  }

  /// What light keeps that does what `likely` of each channel do; `passed`: with how much of it.
  void weigh(glm::vec3& weight, const glm::vec3& passed, const glm::vec3& likely) {
    weight *= passed;
    density *= likely;
    const float mean = (density.r + density.g + density.b) / 3.0F;
    if (!(mean > 0.0F)) {
      weight = density = glm::vec3(0.0F);
      return;
    }
    weight /= mean;
    density /= mean;
  }
};

class Flights {
 public:
  /// `sigma_t`: per unit of the distances; `albedo`: of one scattering.
  Flights(const glm::vec3& sigma_t, const glm::vec3& albedo, transport::Random& random, const Hero& hero = {})
      : random_(random), sigma_t_(sigma_t), albedo_(albedo), hero_(hero) {
    hero_.choose(random);
  }

  /// With what came before.
  const Hero& hero() const { return hero_; }

  /// Of what came in.
  const glm::vec3& weight() const { return weight_; }

  /// How far light flies on a way of this length; as far or farther where it meets nothing.
  float fly(float chord) {
    const float sigma_t = sigma_t_[hero_.channel];
    const float flight = sigma_t > 0.0F ? -std::log1p(-random_.uniform()) / sigma_t : chord;
    const glm::vec3 passed = glm::exp(-sigma_t_ * std::min(flight, chord));
    if (flight < chord)
      weigh(passed * sigma_t_ * albedo_, passed * sigma_t_);
    else
      weigh(passed, passed);
    return flight;
  }

  /// The same of what meets something on the way.
  float fly_within(float chord) {
    const glm::vec3 within =
        -glm::vec3(std::expm1(-sigma_t_.r * chord), std::expm1(-sigma_t_.g * chord), std::expm1(-sigma_t_.b * chord));
    if (!(within[hero_.channel] > 0.0F)) {
      weight_ = glm::vec3(0.0F);
      return 0.0F;
    }
    const float u = random_.uniform();
    const float sigma_t = sigma_t_[hero_.channel];
    // A chord of so few mean free paths that its exponential is a straight line.
    const float flight = sigma_t * chord > 1e-3F ? -std::log1p(-u * within[hero_.channel]) / sigma_t : u * chord;
    const glm::vec3 passed = glm::exp(-sigma_t_ * flight) * sigma_t_;
    weigh(passed * albedo_, passed / glm::max(within, 1e-30F));
    begun_with_ = std::max({weight_.r, weight_.g, weight_.b});
    return std::min(flight, 0.999999F * chord);
  }

  /// Whether it is followed on; what is faint is given up at random.
  bool survives() {
    const float most = std::max({weight_.r, weight_.g, weight_.b});
    if (!(most > 0.0F)) return false;
    const float faint = 0.05F * begun_with_;
    if (most > faint) return true;
    if (random_.uniform() * faint >= most) return false;
    weight_ *= faint / most;
    return true;
  }

 private:
  void weigh(const glm::vec3& passed, const glm::vec3& density) { hero_.weigh(weight_, passed, density); }

  transport::Random& random_;
  glm::vec3 sigma_t_;
  glm::vec3 albedo_;
  glm::vec3 weight_{1.0F};  // of each channel, over the mean density
  float begun_with_ = 1.0F;
  Hero hero_;
};

}  // namespace mesograin::heap

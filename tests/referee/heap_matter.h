// What light meets in a scene of many meshes, in one channel.
#pragma once

#include <vector>

#include "rough_interface.h"
#include "scene/material.h"

namespace mesograin::referee {

/// A material, per scene unit.
struct Matter {
  bool diffuse;
  double reflectance;
  double sigma_s, sigma_t, g;
  RoughInterface surface;

  Matter(const scene::Material& of, int channel)
      : diffuse(of.model == scene::Model::lambert),
        reflectance(of.reflectance[channel]),
        sigma_s(of.scale * of.sigma_s[channel]),
        sigma_t(sigma_s + of.scale * of.sigma_a[channel]),
        g(of.g),
        surface{{of.boundary == scene::Boundary::dielectric ? of.eta : 1.0}, of.roughness} {}

  bool operator==(const Matter& other) const {
    return diffuse == other.diffuse && reflectance == other.reflectance && sigma_s == other.sigma_s &&
           sigma_t == other.sigma_t;
  }
};

/// One channel of all that stands there.
struct Channel {
  int number;
  std::vector<Matter> matter;  // by instance
};

}  // namespace mesograin::referee

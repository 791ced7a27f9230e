// Photons of a sun through a body: walks with smooth refraction, inner reflection and Henyey and Greenstein's phase
// function. What left after n scatterings counts albedo^n, so one set of walks serves every albedo.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "transport/body.h"
#include "transport/effort.h"

namespace mesograin::transport {

struct Medium {
  double sigma_t = 1.0;  ///< extinction, per unit of the body
  double g = 0.0;
  double eta = 1.0;  ///< index inside over outside; 1 is no interface
};

/// A photon that has been inside, as it leaves.
struct Departure {
  glm::vec3 place;
  glm::vec3 direction;  ///< outside
  glm::vec3 normal;
  int scatterings;
};

struct PhotonTally {
  std::vector<double> sums;  ///< as `add` left them, over all photons that met the body
  std::uint64_t met = 0;     ///< photons that met the body
  std::uint64_t lost = 0;    ///< of them, walks that came to no end
};

/// Sends `photons` of them, parallel light from `to_light`, through the rectangle around the body. `add(departure,
/// sums)` is called for each that leaves from inside, from several threads with sums of their own.
PhotonTally trace_photons(const Body& body, const Medium& medium, const glm::vec3& to_light, std::uint64_t photons,
                          std::size_t tally_size, const std::function<void(const Departure&, std::span<double>)>& add,
                          const Effort& effort = {});

}  // namespace mesograin::transport

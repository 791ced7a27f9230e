// Best candidates (Mitchell, "Spectrally optimal sampling for distribution ray tracing", 1991).
#include "render/spread_directions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>

#include "transport/random.h"

namespace mesograin::render {
namespace {

constexpr std::size_t corners = 4;
constexpr std::uint32_t directions_in_run = 256;
constexpr int candidates = 64;

// An irradiance of level ground that is off by one direction's, straight from above, against distances.
constexpr double cost_of_irradiance = 30.0;

using Tetrahedron = std::array<glm::dvec3, corners>;

const Tetrahedron upright = {glm::normalize(glm::dvec3(1.0, 1.0, 1.0)), glm::normalize(glm::dvec3(1.0, -1.0, -1.0)),
                             glm::normalize(glm::dvec3(-1.0, 1.0, -1.0)), glm::normalize(glm::dvec3(-1.0, -1.0, 1.0))};

/// Any turn, all as likely (Shoemake, "Uniform random rotations", 1992).
glm::dquat any_turn(transport::Random& random) {
  const double share = random.uniform();
  const double first = glm::two_pi<double>() * random.uniform();
  const double second = glm::two_pi<double>() * random.uniform();
  const double low = std::sqrt(1.0 - share), high = std::sqrt(share);
  return {high * std::cos(second), low * std::sin(first), low * std::cos(first), high * std::sin(second)};
}

/// Beyond that of an even light.
double irradiance_of(const Tetrahedron& tetrahedron) {
  double sum = -0.25 * corners;
  for (const glm::dvec3& corner : tetrahedron) sum += std::max(corner.z, 0.0);
  return sum;
}

double sum_of_distances(const Tetrahedron& tetrahedron, const std::vector<glm::dvec3>& others) {
  double sum = 0.0;
  for (const glm::dvec3& corner : tetrahedron)
    for (const glm::dvec3& other : others) sum += glm::distance(corner, other);
  return sum;
}

}  // namespace

glm::dvec3 SpreadDirections::at(std::uint32_t index, std::uint32_t seed) {
  const std::uint32_t run = index / directions_in_run;
  if (directions_.empty() || run != run_ || seed != seed_) begin(run, seed);
  const std::size_t place = index % directions_in_run;
  while (directions_.size() <= place) add_tetrahedron();
  return turn_ * directions_[place];
}

void SpreadDirections::begin(std::uint32_t run, std::uint32_t seed) {
  seed_ = seed;
  run_ = run;
  directions_.clear();
  irradiance_ = 0.0;
  transport::Random random(seed_, run_);
  turn_ = run_ == 0 ? glm::dquat(1.0, 0.0, 0.0, 0.0) : any_turn(random);
}

void SpreadDirections::add_tetrahedron() {
  transport::Random random((static_cast<std::uint64_t>(seed_) << 32U) + run_, directions_.size());
  Tetrahedron best = upright;
  double most = -std::numeric_limits<double>::infinity();
  for (int candidate = 0; candidate < candidates; ++candidate) {
    Tetrahedron tried;
    const glm::dquat turn = any_turn(random);
    std::transform(upright.begin(), upright.end(), tried.begin(), [&](const glm::dvec3& at) { return turn * at; });
    const double irradiance = irradiance_ + irradiance_of(tried);
    const double worth = sum_of_distances(tried, directions_) - cost_of_irradiance * irradiance * irradiance;
    if (worth <= most) continue;
    most = worth;
    best = tried;
  }
  irradiance_ += irradiance_of(best);
  directions_.insert(directions_.end(), best.begin(), best.end());
}

}  // namespace mesograin::render

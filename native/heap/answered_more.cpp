// Few walks through both, of the same random numbers: what these are off is off in both, and hardly in their ratio.
#include "heap/answered_more.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <optional>

#include "heap/sphere_walk.h"
#include "transport/random.h"

namespace mesograin::heap {
namespace {

constexpr int walks = 256;

// What sends out less than this was black, and nothing tells how much more it is now.
constexpr float black = 1e-6F;

glm::vec3 leaves(const Optics& optics) {
  glm::vec3 sum(0.0F);
  for (int i = 0; i < walks; ++i) {
    transport::Random random(0, static_cast<std::uint64_t>(i));
    const float mu = std::sqrt((static_cast<float>(i) + random.uniform()) / walks);
    if (const std::optional<Outcome> outcome = walk(optics, Sense::from_light, mu, random)) sum += outcome->weight;
  }
  return sum / static_cast<float>(walks);
}

}  // namespace

AnsweredMore answered_more(const Optics& now, const Optics& before) {
  AnsweredMore more;
  if (now == before) return more;
  const glm::vec3 is = leaves(now);
  const glm::vec3 was = leaves(before);
  const glm::vec3 met_more(now.met() / glm::max(before.met(), 1e-12));
  for (int channel = 0; channel < 3; ++channel) {
    if (was[channel] <= black) continue;
    more.of_all[channel] = is[channel] / was[channel];
    more.of_met[channel] = more.of_all[channel] / std::max(met_more[channel], 1e-12F);
  }
  return more;
}

std::vector<AnsweredMore> answered_more(const std::vector<Optics>& now, const std::vector<Optics>& before) {
  std::vector<AnsweredMore> more;
  for (std::size_t kind = 0; kind < std::min(now.size(), before.size()); ++kind)
    more.push_back(answered_more(now[kind], before[kind]));
  more.resize(now.size());
  return more;
}

}  // namespace mesograin::heap

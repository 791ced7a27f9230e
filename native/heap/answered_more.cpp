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

constexpr int most_walks = 256;

// A redraw waits for them: where kinds are many, each has fewer, which are off alike in all.
constexpr std::size_t walks_of_all = 1024;
constexpr std::size_t fewest_walks = 64;

// What sends out less than this was black, and nothing tells how much more it is now.
constexpr float black = 1e-6F;

struct Leaves {
  glm::vec3 all{0.0F};
  glm::vec3 entered{0.0F};
};

Leaves leaves(const Optics& optics, int walks) {
  Leaves sum;
  for (int i = 0; i < walks; ++i) {
    transport::Random random(0, static_cast<std::uint64_t>(i));
    const float mu = std::sqrt((static_cast<float>(i) + random.uniform()) / static_cast<float>(walks));
    const std::optional<Outcome> outcome = walk(optics, Sense::from_light, mu, random);
    if (!outcome) continue;
    sum.all += outcome->weight / static_cast<float>(walks);
    if (outcome->entered()) sum.entered += outcome->weight / static_cast<float>(walks);
  }
  return sum;
}

AnsweredMore found_by(const Optics& now, const Optics& before, int walks) {
  AnsweredMore more;
  if (now == before) return more;
  const Leaves is = leaves(now, walks);
  const Leaves was = leaves(before, walks);
  const glm::vec3 met_more(now.met() / glm::max(before.met(), 1e-12));
  for (int channel = 0; channel < 3; ++channel) {
    if (was.entered[channel] > black) more.of_entered[channel] = is.entered[channel] / was.entered[channel];
    if (was.all[channel] <= black) continue;
    more.of_all[channel] = is.all[channel] / was.all[channel];
    more.of_met[channel] = more.of_all[channel] / std::max(met_more[channel], 1e-12F);
  }
  return more;
}

}  // namespace

AnsweredMore answered_more(const Optics& now, const Optics& before) { return found_by(now, before, most_walks); }

std::vector<AnsweredMore> answered_more(const std::vector<Optics>& now, const std::vector<Optics>& before) {
  const std::size_t each = walks_of_all / std::max(now.size(), std::size_t{1});
  const int walks = static_cast<int>(std::clamp(each, fewest_walks, std::size_t{most_walks}));
  std::vector<AnsweredMore> more;
  for (std::size_t kind = 0; kind < std::min(now.size(), before.size()); ++kind)
    more.push_back(found_by(now[kind], before[kind], walks));
  more.resize(now.size());
  return more;
}

}  // namespace mesograin::heap

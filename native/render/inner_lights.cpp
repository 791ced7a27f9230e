// Grains side by side, each by walks of its own.
#include "render/inner_lights.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "render/cast_work.h"
#include "transport/random.h"

namespace mesograin::render {
namespace {

// Walks of one sample: as many as a grain has pixels, a quarter of those that the pixels themselves take, and not so
// few that one with few pixels is never known.
constexpr int fewest_at_once = 16;

// In all. From the one on the polynomial is no farther off than what it replaces; beyond the other it gets no better.
constexpr int fewest_walks = 384;
constexpr int most_walks = 2048;

// That one view keeps, of 3.5 kB each. Where more are seen, each has too few pixels to be worth it.
constexpr std::size_t most_lights = 8192;

}  // namespace

void InnerLights::keep_to(const std::shared_ptr<const heap::Gather>& gather) {
  if (gather_.lock() == gather) return;
  gather_ = gather;
  lights_.clear();
}

const heap::InnerLight* InnerLights::of(std::uint32_t grain) const {
  const auto found = lights_.find(grain);
  return found != lights_.end() && found->second->walks() >= fewest_walks ? found->second.get() : nullptr;
}

void InnerLights::learn(const Pixels& pixels, const heap::Facets& facets, std::uint32_t seed, const GoOn& go_on) {
  if (pixels.size() > most_lights) return;
  if (lights_.size() + pixels.size() > most_lights)
    std::erase_if(lights_, [&](const auto& light) { return !pixels.contains(light.first); });
  const std::shared_ptr<const heap::Gather> gather = gather_.lock();
  struct Work {
    std::uint32_t grain;
    int walks;
    heap::InnerLight* light;
  };
  std::vector<Work> works;
  for (const auto& [grain, count] : pixels) {
    if (!gather->tells_inner_light(grain)) continue;
    std::unique_ptr<heap::InnerLight>& light = lights_[grain];
    if (!light) light = std::make_unique<heap::InnerLight>();
    const int walks = std::min(std::max(count, fewest_at_once), most_walks - light->walks());
    if (walks > 0) works.push_back({grain, walks, light.get()});
  }
  cast_rows(static_cast<int>(works.size()), go_on, [&](int first, int end) {
    for (int i = first; i < end; ++i) {
      const Work& work = works[static_cast<std::size_t>(i)];
      const auto begun = static_cast<std::uint64_t>(work.light->walks());
      transport::Random random((static_cast<std::uint64_t>(seed) << 32U) + work.grain, begun);
      gather->learn(work.grain, facets, work.walks, random, *work.light);
      work.light->fit();
    }
  });
}

}  // namespace mesograin::render

// By the unit: what a unit costs is the shadows below its grains' surfaces, which all of them have or none.
#include "render/passes/told_units.h"

#include <algorithm>
#include <cmath>
#include <glm/vec4.hpp>

#include "render/levels.h"
#include "render/surfaces.h"

namespace mesograin::render {
namespace {

// As large as its usual grain is in the middle of all of them, or half as large as its largest is where it is nearest.
float pixels_of(const InstanceGroup& group, const Instances& instances, const PixelsAcross& pixels_across) {
  const Bounds& bounds = instances.bounds();
  const double usual = group.typical_scale * instances.prototypes()[group.prototype].mesh->reach();
  return std::max(pixels_across.of(glm::vec4(0.5 * (bounds.lower + bounds.upper), usual)),
                  0.5F * pixels_across.most(bounds, group.largest));
}

// In how many of the samples that have passed, of a share of all: evenly.
bool is_chosen(std::uint32_t sample, float share) {
  return std::floor((static_cast<float>(sample) + 1.0F) * share) > std::floor(static_cast<float>(sample) * share);
}

}  // namespace

std::vector<bool> told_units(const Sample& sample) {
  const Instances* instances = sample.content.instances();
  std::vector<bool> told(instances == nullptr ? 0 : instances->groups().size(), false);
  const PixelsAcross pixels_across(anchor_to_clip(sample.content, sample.camera), sample.size);
  for (std::size_t unit = 0; unit < told.size(); ++unit) {
    const InstanceGroup& group = instances->groups()[unit];
    // What a model shows at the surface alone costs no more than numbers.
    if (!sample.exchange.tells_entered(unit) || !group.material->asks_below()) continue;
    const float pixels = pixels_of(group, *instances, pixels_across);
    told[unit] = is_chosen(sample.index, share_told(pixels, sample.awaited));
  }
  return told;
}

std::size_t told_grains(const Sample& sample, SurfacePass& surfaces) {
  if (std::find(sample.told.begin(), sample.told.end(), true) == sample.told.end()) return 0;
  const Instances& instances = *sample.content.instances();
  std::vector<bool> seen(instances.count(), !sample.cast);
  if (sample.cast)
    for (const glm::vec4& normal : surfaces.seen(sample).normals) {
      const float number = std::abs(normal.w) - 1.0F;
      if (number >= 0.0F && number < static_cast<float>(seen.size())) seen[static_cast<std::size_t>(number)] = true;
    }
  std::size_t grains = 0;
  for (std::size_t unit = 0; unit < sample.told.size(); ++unit) {
    if (!sample.told[unit]) continue;
    const auto first = seen.begin() + static_cast<std::ptrdiff_t>(instances.groups()[unit].first);
    grains += static_cast<std::size_t>(std::count(first, first + instances.groups()[unit].count, true));
  }
  return grains;
}

}  // namespace mesograin::render

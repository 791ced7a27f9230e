// The light in grains that a view shows again and again, kept from one picture to the next: found beside its further
// samples, so that the first one of another picture, which a drag shows, needs no walks.
#pragma once

#include <cstdint>
#include <memory>
#include <unordered_map>

#include "heap/gather.h"
#include "render/go_on.h"

namespace mesograin::render {

class InnerLights {
 public:
  /// Of each grain that is seen, how many show it.
  using Pixels = std::unordered_map<std::uint32_t, int>;

  /// Forgets what was found of other grains or in another light.
  void keep_to(const std::shared_ptr<const heap::Gather>& gather);

  /// Of a grain of which enough is known; else null.
  const heap::InnerLight* of(std::uint32_t grain) const;

  /// Finds some more of each, unless it is to end.
  void learn(const Pixels& pixels, const heap::Facets& facets, std::uint32_t seed, const GoOn& go_on);

 private:
  std::weak_ptr<const heap::Gather> gather_;
  std::unordered_map<std::uint32_t, std::unique_ptr<heap::InnerLight>> lights_;
};

}  // namespace mesograin::render

// What a world must satisfy.
#include "scene/world.h"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>
#include <utility>

#include "base/error.h"

namespace mesograin::scene {
namespace {

template <typename Colour>
bool is_light(const Colour& colour) {
  for (int channel = 0; channel < 3; ++channel)
    if (!(colour[channel] >= 0 && std::isfinite(colour[channel]))) return false;
  return true;
}

// Of a World or a Backdrop.
template <typename Around>
void validate_around(const Around& around) {
  if (!is_light(around.radiance))
    throw Error("A world's radiance must be finite and not negative; got ({}, {}, {}).", around.radiance.r,
                around.radiance.g, around.radiance.b);
  const glm::dmat3 unit = glm::transpose(around.world_to_image) * around.world_to_image;
  constexpr double tolerance = 1e-5;
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row)
      if (!(std::abs(unit[column][row] - (column == row ? 1.0 : 0.0)) <= tolerance))
        throw Error(
            "A world's rotation must be three directions of unit length, square to each other; their products are "
            "off by {}.",
            std::abs(unit[column][row] - (column == row ? 1.0 : 0.0)));
}

}  // namespace

Surroundings::Surroundings(int width, int height, std::vector<glm::vec3> texels)
    : width_(width), height_(height), texels_(std::move(texels)) {
  if (width < 1 || height < 1 || texels_.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
    throw Error("A world's image needs a texel for each of its {} x {} places; got {}.", width, height, texels_.size());
  const auto wrong = std::find_if_not(texels_.begin(), texels_.end(), is_light<glm::vec3>);
  if (wrong == texels_.end()) return;
  const auto index = wrong - texels_.begin();
  throw Error("A world's image must be finite and not negative; the texel in column {} of row {} is ({}, {}, {}).",
              index % width, index / width, wrong->r, wrong->g, wrong->b);
}

Backdrop World::seen_by_camera() const {
  if (film_transparent) return {};
  return seen && backdrop ? *backdrop : Backdrop{radiance, image, world_to_image};
}

void validate(const World& world) {
  validate_around(world);
  if (world.film_transparent && world.seen)
    throw Error("A world is seen or its film is transparent, not both: set seen or film_transparent to false.");
  if (world.backdrop) validate_around(*world.backdrop);
}

}  // namespace mesograin::scene

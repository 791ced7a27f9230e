// What the light of a picture is made of: each is a picture of its own, and together, but for the normal, they are the
// picture. shaders/models/portions.glsl has the same numbers.
#pragma once

#include <array>
#include <string_view>

namespace mesograin::render {

enum class Portion {
  diffuse,            ///< lights, once off a surface that is no grain's
  specular,           ///< lights and the world in facets
  subsurface,         ///< lights, scattered in a grain
  single_scattering,  ///< of that, once, where a model tells it apart
  transmission,       ///< the world through a grain, unscattered
  exchange,           ///< what grains and walls send each other
  emission,           ///< light of a surface's own
  environment,        ///< the world behind everything
  normal,             ///< no light: the normal that is shaded with
};

inline constexpr std::array<std::string_view, 9> portion_names = {"diffuse",           "specular",     "subsurface",
                                                                  "single_scattering", "transmission", "exchange",
                                                                  "emission",          "environment",  "normal"};

}  // namespace mesograin::render

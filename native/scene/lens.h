// The opening that a camera looks through: what is out of focus is blurred in its shape.
#pragma once

#include <glm/vec2.hpp>

namespace mesograin::scene {

struct Lens {
  double aperture_radius = 0.0;  ///< scene units; of the circle around the opening
  double focus_distance = 1.0;   ///< scene units, along the camera's axis: what is there is sharp
  int blades = 0;                ///< of the diaphragm; fewer than 3 leave a round opening
  double rotation = 0.0;         ///< of the blades, radians
  double ratio = 1.0;            ///< height over width of the opening; above 1 as an anamorphic lens shows it

  bool operator==(const Lens&) const = default;

  /// A place in the opening, from its middle, in scene units: x to the camera's right, y up. `random` in [0, 1)^2;
  /// evenly distributed if that is.
  glm::dvec2 place(const glm::dvec2& random) const;
};

/// Throws Error for numbers that no lens has.
void validate(const Lens& lens);

}  // namespace mesograin::scene

// A camera as two matrices, so that perspective, orthographic, shifted and fitted sensors are all the same to the
// renderer.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "scene/lens.h"

namespace mesograin::scene {

struct Camera {
  glm::dmat4 world_to_camera{1.0};  ///< camera space looks along -z, y is up
  glm::dmat4 camera_to_clip{1.0};   ///< OpenGL clip space, depth -1 near and 1 far
  std::optional<Lens> lens{};       ///< without one everything is sharp

  bool operator==(const Camera&) const = default;

  /// A pinhole at `position`; `fov_degrees` spans the image's shorter side. The planes default to the distance to
  /// `look_at` times 1/100 and 100. Throws Error if the vectors do not span a view or the angle is not in (0, 180).
  static Camera look_at(glm::dvec3 position, glm::dvec3 look_at, glm::dvec3 up, double fov_degrees, double aspect = 1.0,
                        double near_plane = 0.0, double far_plane = 0.0);

  /// The pinhole at this place of the lens (Lens::place), or for a parallel projection its rays through there: what is
  /// in focus stays where it is in the picture.
  Camera through(const glm::dvec2& place) const;
};

/// Throws Error if a number is not finite or a matrix cannot be inverted.
void validate(const Camera& camera);

}  // namespace mesograin::scene

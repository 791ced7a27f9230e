// Builds a pinhole's matrices and checks those that come from outside.
#include "scene/camera.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "base/error.h"

namespace mesograin::scene {
namespace {

void require_invertible(const glm::dmat4& matrix, const char* name) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!std::isfinite(matrix[column][row]))
        throw Error("The camera's {} must be finite; row {}, column {} is {}.", name, row, column, matrix[column][row]);
  if (glm::determinant(matrix) == 0.0) throw Error("The camera's {} cannot be inverted.", name);
}

}  // namespace

Camera Camera::look_at(glm::dvec3 position, glm::dvec3 look_at, glm::dvec3 up, double fov_degrees, double aspect,
                       double near_plane, double far_plane) {
  const glm::dvec3 forward = look_at - position;
  if (!(glm::length(glm::cross(forward, up)) > 0.0))
    throw Error("A camera needs look_at apart from its position, and an up vector that does not point along the view.");
  if (!(fov_degrees > 0.0 && fov_degrees < 180.0))
    throw Error("fov_degrees must lie between 0 and 180; got {}.", fov_degrees);
  if (!(aspect > 0.0 && std::isfinite(aspect))) throw Error("A camera's aspect must be positive; got {}.", aspect);
  const double distance = glm::length(forward);
  if (near_plane <= 0.0) near_plane = distance / 100.0;
  if (far_plane <= 0.0) far_plane = distance * 100.0;
  const double half_height = std::tan(glm::radians(fov_degrees) / 2.0) / std::min(aspect, 1.0);
  return {glm::lookAt(position, look_at, up),
          glm::perspective(2.0 * std::atan(half_height), aspect, near_plane, far_plane),
          {}};
}

Camera Camera::through(const glm::dvec2& place) const {
  // Space is sheared along the lens, so that its plane of focus stays and that place comes to the middle (Haeberli and
  // Akeley, "The Accumulation Buffer", 1990, section 4).
  glm::dmat4 shear(1.0);
  for (int axis = 0; axis < 2; ++axis) {
    shear[2][axis] = -place[axis] / lens->focus_distance;
    shear[3][axis] = -place[axis];
  }
  return {shear * world_to_camera, camera_to_clip, {}};
}

void validate(const Camera& camera) {
  require_invertible(camera.world_to_camera, "world_to_camera");
  require_invertible(camera.camera_to_clip, "camera_to_clip");
  if (camera.lens) validate(*camera.lens);
}

}  // namespace mesograin::scene

// Where a sample is seen from.
#include "render/passes/sample.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace mesograin::render {

glm::vec4 Sample::viewer(const glm::dvec3& origin) const {
  const glm::dmat4 camera_to_world = glm::inverse(camera.world_to_camera);
  // A perspective projection takes its w from depth; an orthographic one is affine and sees along one direction.
  const bool orthographic = camera.camera_to_clip[2][3] == 0.0;
  return orthographic ? glm::vec4(glm::normalize(glm::dvec3(camera_to_world[2])), 0.0)
                      : glm::vec4(glm::dvec3(camera_to_world[3]) - origin, 1.0);
}

}  // namespace mesograin::render

// Looks at some of the pixels; what lies between them is as near as their neighbours are.
#include "render/receivers.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace mesograin::render {

Receivers receivers(const gl::Framebuffer& surfaces, int width, int height,
                    const std::function<Receiver(std::size_t instance)>& receiver) {
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  std::vector<glm::vec4> positions(pixels);
  std::vector<glm::vec4> normals(pixels);
  surfaces.read(&positions.front().x, 0);
  surfaces.read(&normals.front().x, 1);
  Receivers found;
  // Every pixel of a small picture, a few ten thousand of a large one.
  const int step = std::max(1, std::max(width, height) / 256);
  for (int y = 0; y < height; y += step) {
    std::size_t before = 0;
    for (int x = 0; x < width; x += step) {
      const std::size_t pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
      const auto number = static_cast<std::size_t>(std::abs(normals[pixel].w));
      const bool same = number == before;
      before = number;
      if (number == 0) continue;
      const Receiver seen = receiver(number - 1);
      std::vector<glm::vec4>& balls = seen.ground ? found.ground : found.grains;
      if (seen.whole) {
        if (!same) balls.push_back(seen.ball);
        continue;
      }
      const glm::vec3 place = glm::vec3(seen.ball) + glm::vec3(positions[pixel]);
      // As far as the pixel beside it that was looked at.
      balls.emplace_back(place, same && !balls.empty() ? glm::distance(place, glm::vec3(balls.back())) : 0.0F);
    }
  }
  return found;
}

}  // namespace mesograin::render

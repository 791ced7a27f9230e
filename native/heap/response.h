// What a grain sends out, to order 2, because of light that meets it in one place from one side: the mean of all walks.
#pragma once

#include <glm/vec3.hpp>

#include "heap/coefficients.h"
#include "heap/spread.h"

namespace mesograin::heap {

/// In the frame of sphere_walk.h; as much on both sides of the plane in which light comes.
struct Response {
  glm::vec3 mean{0.0F};
  glm::vec3 along_x{0.0F};  ///< means of the place's coordinates
  glm::vec3 along_z{0.0F};
  glm::vec3 square_x{0.0F};  ///< of their squares, less that of y
  glm::vec3 square_z{0.0F};
  glm::vec3 product{0.0F};  ///< of x and z

  /// So much of the light leaves in a place.
  void add(const glm::vec3& share, const glm::vec3& place) {
    mean += share;
    along_x += share * place.x;
    along_z += share * place.z;
    square_x += share * (place.x * place.x - place.y * place.y);
    square_z += share * (place.z * place.z - place.y * place.y);
    product += share * place.x * place.z;
  }

  /// Adds it where `light` comes in so turned, as Coefficients::add() of all places would.
  void add_to(Coefficients& sum, const TurnedFrame& frame, const glm::vec3& light) const {
    const glm::vec3 x = frame * glm::vec3(1.0F, 0.0F, 0.0F);
    const glm::vec3 z = frame * glm::vec3(0.0F, 0.0F, 1.0F);
    const SecondOrder of_x = second_order(x);
    const SecondOrder of_z = second_order(z);
    const SecondOrder of_both = second_order(x + z);
    SecondOrders::Numbers& second = sum.second.made();
    for (int channel = 0; channel < 3; ++channel) {
      const auto index = static_cast<std::size_t>(channel);
      const glm::vec3 slope = 3.0F * (along_x[channel] * x + along_z[channel] * z);
      sum.channels[index] += light[channel] * glm::vec4(slope, mean[channel]);
      // The squares of x, y and z together are the same in all directions.
      for (std::size_t i = 0; i < of_x.size(); ++i)
        second[index][i] += 5.0F * light[channel] *
                            ((square_x[channel] - product[channel]) * of_x[i] +
                             (square_z[channel] - product[channel]) * of_z[i] + product[channel] * of_both[i]);
    }
  }
};

}  // namespace mesograin::heap

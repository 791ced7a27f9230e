// Points and frames for a grain's rays.
#pragma once

#include <array>
#include <cmath>
#include <glm/vec3.hpp>
#include <numbers>

#include "transport/directions.h"
#include "transport/random.h"

namespace mesograin::heap {

/// Points of the additive recurrence R5 (Roberts 2018, "The unreasonable effectiveness of quasirandom sequences"; its
/// generator is the root of x^6 = x + 1), shifted at random.
class Spread {
 public:
  explicit Spread(transport::Random& random) {
    for (float& shift : shifts_) shift = random.uniform();
  }

  std::array<float, 5> point(int index) const {
    constexpr double generator = 1.1347241384015194;
    std::array<float, 5> point{};
    double step = 1.0;
    for (std::size_t axis = 0; axis < point.size(); ++axis) {
      step /= generator;
      const double at = shifts_[axis] + step * (index + 1);
      point[axis] = std::min(static_cast<float>(at - std::floor(at)), 0.99999994F);
    }
    return point;
  }

 private:
  std::array<float, 5> shifts_{};
};

/// A frame around a normal, turned about it by a share of a full turn, or so that its x axis lies along a direction.
class TurnedFrame {
 public:
  TurnedFrame(const glm::vec3& normal, float turn) : normal_(normal) {
    glm::vec3 first, second;
    transport::make_frame(normal, first, second);
    const float azimuth = 2.0F * std::numbers::pi_v<float> * turn;
    x_ = std::cos(azimuth) * first + std::sin(azimuth) * second;
    y_ = glm::cross(normal_, x_);
  }

  TurnedFrame(const glm::vec3& normal, const glm::vec3& along) : normal_(normal) {
    glm::vec3 second;
    transport::make_frame(normal, x_, second);
    const glm::vec3 tangential = along - glm::dot(along, normal) * normal;
    const float length = glm::length(tangential);
    if (length > 1e-5F) x_ = tangential / length;
    y_ = glm::cross(normal_, x_);
  }

  glm::vec3 operator*(const glm::vec3& local) const { return local.x * x_ + local.y * y_ + local.z * normal_; }

 private:
  glm::vec3 normal_;
  glm::vec3 x_{0.0F};
  glm::vec3 y_{0.0F};
};

}  // namespace mesograin::heap

// Parallel light on a body: the rectangle that all of it has to pass.
#pragma once

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "transport/body.h"
#include "transport/directions.h"

namespace mesograin::transport {

class Incidence {
 public:
  Incidence(const Body& body, const glm::vec3& to_light) : to_light_(glm::normalize(to_light)) {
    make_frame(to_light_, first_, second_);
    lower_ = glm::vec2(2.0F);
    upper_ = glm::vec2(-2.0F);
    for (const glm::vec3& position : body.positions()) {
      const glm::vec2 seen(glm::dot(position, first_), glm::dot(position, second_));
      lower_ = {std::min(lower_.x, seen.x), std::min(lower_.y, seen.y)};
      upper_ = {std::max(upper_.x, seen.x), std::max(upper_.y, seen.y)};
    }
  }

  const glm::vec3& to_light() const { return to_light_; }

  /// In squared units of the body.
  float area() const { return (upper_.x - lower_.x) * (upper_.y - lower_.y); }

  /// Where a ray starts, outside the body; uniform over the rectangle for u and v uniform in [0, 1).
  glm::vec3 start(float u, float v) const {
    const glm::vec2 seen(lower_.x + u * (upper_.x - lower_.x), lower_.y + v * (upper_.y - lower_.y));
    return seen.x * first_ + seen.y * second_ + 2.0F * to_light_;
  }

 private:
  glm::vec3 to_light_;
  glm::vec3 first_{0.0F};
  glm::vec3 second_{0.0F};
  glm::vec2 lower_;
  glm::vec2 upper_;
};

}  // namespace mesograin::transport

// How much of the way of parallel light to any place is inside a body that light goes straight through: lines side by
// side, on each of which it is known where the light enters and where it leaves.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "transport/body.h"

namespace mesograin::transport {

/// Places have coordinates across the light, by `first` and `second`, and along it, growing away from it.
class LightWays {
 public:
  static constexpr int usual_lines = 1 << 17;

  /// About so many lines, as far apart one way as the other.
  LightWays(const Body& body, const glm::vec3& to_light, int lines = usual_lines);

  /// Inside the body, from where light enters up to a place of it; that of the lines around the place which meet the
  /// body.
  float way(const glm::vec3& place) const;

  /// Of one line, up to a place so far along it: of `inside` as lines() has it.
  static float way(const glm::vec4& inside, float along);

  const glm::vec3& to_light() const { return to_light_; }

  /// Across the light, unit length.
  const glm::vec3& first() const { return first_; }
  const glm::vec3& second() const { return second_; }

  /// The corner of the rectangle that the body fills, by `first` and `second`. Lines lie in the middles of its texels.
  const glm::vec2& lower() const { return lower_; }
  const glm::vec2& texel() const { return texel_; }  ///< a texel's sides
  const glm::ivec2& size() const { return size_; }   ///< in texels

  /// By `first`, then by `second`: where light enters, where it leaves, and both once more; no way where a line meets
  /// no more of the body. Of lines that enter more often the narrowest gaps are closed, by moving what lies before
  /// them.
  const std::vector<glm::vec4>& lines() const { return lines_; }

 private:
  void lay_out(const Body& body, int lines);
  void cross(const Body& body);

  glm::vec3 to_light_;
  glm::vec3 first_{1.0F, 0.0F, 0.0F};
  glm::vec3 second_{0.0F, 1.0F, 0.0F};
  glm::vec2 lower_{0.0F};
  glm::vec2 texel_{1.0F};
  glm::ivec2 size_{1};
  std::vector<glm::vec4> lines_;
};

}  // namespace mesograin::transport

// The light in one grain that has met something there before, as a polynomial of the place: once it is known, what is
// seen of the grain needs no walks (Jarosz et al., "Radiance caching for participating media", 2008, who cache at
// points; here all of a grain's walks are one regression).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace mesograin::heap {

class InnerLight {
 public:
  /// One scattering of a walk from the viewer: its place, from the grain's middle and in its radius, the walk's weight
  /// after it, and what the walk found later, all in all.
  void add(const glm::vec3& place, const glm::vec3& weight, const glm::vec3& found);

  /// After a walk.
  void count() { ++walks_; }

  int walks() const { return walks_; }

  /// Makes what was added known to at().
  void fit();

  /// What a walk of weight 1 after a scattering there finds later, on average.
  glm::vec3 at(const glm::vec3& place) const;

  /// The same on a straight line.
  class Line {
   public:
    /// `share`: of the way from its beginning to its end.
    float at(float share, int channel) const {
      const glm::vec4& is = terms_[static_cast<std::size_t>(channel)];
      return std::max(is.x + share * (is.y + share * (is.z + share * is.w)), 0.0F);
    }

   private:
    friend class InnerLight;
    std::array<glm::vec4, 3> terms_{};  // of each channel, from order 0 on
  };
  Line along(const glm::vec3& from, const glm::vec3& to) const;

 private:
  // To order 3.
  static constexpr std::size_t terms = 20;
  static constexpr std::size_t products = terms * (terms + 1) / 2;

  static std::array<float, terms> basis(const glm::vec3& place);
  glm::vec3 sum_at(const glm::vec3& place) const;

  int walks_ = 0;
  int scatterings_ = 0;
  std::array<std::array<float, products>, 3> weights_{};  // of each channel, the lower triangle of its matrix
  std::array<std::array<float, terms>, 3> found_{};
  std::array<glm::vec3, terms> fitted_{};
};

}  // namespace mesograin::heap

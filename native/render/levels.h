// How closely light is followed into what is seen of an array's grains, by how large they are seen, and what the
// coarser ways lack, found beside the closest one at a few pixels.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <string_view>
#include <vector>

#include "heap/gather.h"
#include "render/bounds.h"

namespace mesograin::render {

enum class Level : std::uint8_t {
  own_shape,  ///< by walks in its own mesh, or in the ball that it is
  ball,       ///< by walks in the ball of its area
  told,       ///< by what its neighbours are told of it, which costs no walk
};
inline constexpr std::array<std::string_view, 3> level_names = {"own_shape", "ball", "told"};

/// How those grains are shown that light is followed into.
struct SeenByLevel {
  std::array<std::size_t, level_names.size()> grains{};  ///< that pixels show, by each
  std::size_t walks_saved = 0;                           ///< that none was followed of, where it was told
  std::size_t surfaces = 0;                              ///< of grains that refract, of which no more was shaded
};

/// How large balls are seen in a picture of this size.
class PixelsAcross {
 public:
  PixelsAcross(const glm::mat4& to_clip, const glm::ivec2& size);

  /// `ball`: its middle and radius. Infinite where the camera may be in it.
  float of(const glm::vec4& ball) const;

  /// What none of this radius exceeds within these bounds.
  float most(const Bounds& bounds, float radius) const;

 private:
  glm::vec4 depth_;
  float pixels_;  // of what is as long as it is far
};

/// Whether one sample is a picture of its own, to someone who may change something before there is another.
enum class Awaited : std::uint8_t {
  no,
  more_known,  ///< of what has become known of a scene that was shown before
  changed,     ///< of what someone has changed
};

/// In how many of the samples it is told what has entered a grain that refracts, where it is seen so many pixels
/// across: from all to none over a pixel, so that it does not pop.
float share_told(float pixels_across, Awaited awaited);

/// Of a grain that is seen so many pixels across. `mean_free_paths`: to its radius.
Level level_of(bool is_ball, double mean_free_paths, float pixels_across, Awaited awaited = Awaited::no);

/// How much more light the closest way finds than a coarser one, over the grains of each unit of the content: few are
/// asked for both, in each sample, and their means make good for all. What is left is how that differs from place to
/// place.
class Amends {
 public:
  /// One pixel that was looked at both ways.
  struct Probe {
    std::size_t unit;
    Level level;
    heap::Gather::All closest;
    heap::Gather::All coarse;
  };

  struct Factors {
    glm::vec3 scattered{1.0F};  ///< and what others send that has met the grain
    glm::vec3 straight{1.0F};   ///< what is seen straight through it
  };

  void forget() { sums_.clear(); }

  void add(const Probe& probe);

  /// The less certain the pixels are that have told of a unit, the nearer to 1.
  Factors factors(std::size_t unit, Level level) const;

 private:
  struct Pair {
    glm::dvec3 closest{0.0};
    glm::dvec3 coarse{0.0};
    glm::dvec3 squares{0.0};  ///< of how far they are apart

    void add(const glm::dvec3& one, const glm::dvec3& other);
  };
  struct Sums {
    Pair scattered;
    Pair straight;
    int probes = 0;
  };

  std::vector<std::array<Sums, level_names.size()>> sums_;  // of each unit
};

}  // namespace mesograin::render

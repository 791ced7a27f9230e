// What shaders/heap/light_from_grains.glsl and light_of_walls.glsl read of the light between grains.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "gl/buffer.h"
#include "heap/exchange.h"
#include "heap/grains.h"

namespace mesograin::render {

/// What an object is to the light between grains.
struct RoleInHeap {
  std::optional<std::uint32_t> grain;  ///< which of its grains
  std::optional<std::uint32_t> wall;   ///< which of its walls
  bool ball = false;                   ///< of a grain: it is about as round as a sphere
  bool hollow = false;                 ///< of a wall: a grain whose own parts send each other light
  bool pane = false;                   ///< of a grain: clear and thin all over, and others may stand within it

  bool operator==(const RoleInHeap&) const = default;
};

class ToldLight {
 public:
  /// `roles`: of objects, by their numbers; those of grains and walls that `grains` has not yet are dark.
  void tell(const heap::HeapLight& light, const heap::Grains& grains, const std::vector<RoleInHeap>& roles);

  /// Where nothing is known of any.
  void tell_darkness(std::size_t objects);

  void bind() const;
  void reset() { numbers_.reset(); }

  /// Whether of turbid grains it tells what of lights' and the world's light has entered them.
  bool tells_entered() const { return numbers_ && tells_entered_; }

 private:
  std::optional<gl::Buffer> numbers_;  // a vec4 of each object, which says where its others are, and these behind them
  std::optional<gl::Buffer> walls_;
  bool tells_entered_ = false;
};

}  // namespace mesograin::render

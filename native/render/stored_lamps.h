// Lamps beside single grains of stored transport: what each of them does in the grain, found for where it stands. What
// is stored for parallel light has it the same for all of the grain, which beside a lamp it is not.
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "gl/program.h"
#include "gl/volume.h"
#include "render/content.h"
#include "render/lighting.h"
#include "transport/works.h"

namespace mesograin::render {

class StoredLamps {
 public:
  /// Of this content under these lights. What was asked for before and holds still is kept.
  void set(const Content& content, const Lighting& lighting);

  /// What is asked for, known or not.
  std::vector<std::shared_ptr<const transport::Computation>> computations() const;

  /// Sends what has become known. Returns whether any has.
  bool take_news();

  /// Whether a draw's program is to look for any.
  bool any(std::size_t draw) const { return draw < draws_.size() && !draws_[draw].lamps.empty(); }

  /// To a program that looks for them: those that are known, at the nodes of what is stored of the draw's material.
  void bind(const gl::Program& program, std::size_t draw, const DeviceMaterial& material) const;

 private:
  struct Lamp {
    std::size_t light;  // which of those that have a place
    transport::Order order;
    std::shared_ptr<const transport::Computation> computation;
  };
  struct OfDraw {
    std::vector<Lamp> lamps;                                               // by their lights
    std::vector<std::shared_ptr<const transport::StoredTransport>> known;  // of `lamps`, as it was sent; or null
    int stored = 0;                                                        // a bit for each light of which it is sent
    std::optional<gl::Volume> sources;
  };

  /// That was asked for before, or is from now on.
  std::shared_ptr<const transport::Computation> ask(const transport::Order& order,
                                                    const std::vector<OfDraw>& before) const;
  static bool take_news(OfDraw& of);

  std::vector<OfDraw> draws_;
};

}  // namespace mesograin::render

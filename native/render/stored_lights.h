// Suns over single grains of stored transport, and lamps beside them: what each does in the grain, found by itself.
// What is stored for parallel light from anywhere tells of a direction by few functions of it, and of a lamp as if it
// were the same for all of the grain.
#pragma once

#include <cstddef>
#include <glm/mat3x3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "gl/program.h"
#include "gl/volume.h"
#include "render/content.h"
#include "render/lighting.h"
#include "transport/works.h"

namespace mesograin::render {

class StoredLights {
 public:
  /// Of this content under these lights. What was asked for before and holds still is kept.
  void set(const Content& content, const Lighting& lighting);

  /// What is asked for, known or not.
  std::vector<std::shared_ptr<const transport::Computation>> computations() const;

  /// Sends what has become known. Returns whether any has.
  bool take_news();

  /// Whether a draw's program is to look for any, and for any that have a place.
  bool any(std::size_t draw) const { return draw < draws_.size() && !draws_[draw].lights.empty(); }
  bool any_lamps(std::size_t draw) const;

  /// Another one whenever what is known of a draw's lights is.
  int version(std::size_t draw) const { return any(draw) ? draws_[draw].version : 0; }

  /// To a program that looks for them: those that are known, at the nodes of what is stored of the draw's material.
  /// Suns only as the draw stands now, turned by `grain_to_prototype`.
  void bind(const gl::Program& program, std::size_t draw, const DeviceMaterial& material,
            const glm::dmat3& grain_to_prototype) const;

 private:
  struct Light {
    bool sun;
    std::size_t number;  // which of the suns, or of the lights that have a place
    transport::Order order;
    std::shared_ptr<const transport::Computation> computation;
  };
  struct OfDraw {
    std::vector<Light> lights;  // lamps first, each kind by its numbers
    glm::dmat3 grain_to_prototype{1.0};
    std::vector<std::shared_ptr<const transport::StoredTransport>> known;  // of `lights`, as it was sent; or null
    int version = 0;
    int lamps = 0;  // a bit for each of which it is sent
    int suns = 0;
    std::optional<gl::Volume> sources;
  };

  /// That was asked for before, or is from now on.
  std::shared_ptr<const transport::Computation> ask(const transport::Order& order,
                                                    const std::vector<OfDraw>& before) const;
  bool take_news(OfDraw& of);

  std::vector<OfDraw> draws_;
  int versions_ = 0;
};

}  // namespace mesograin::render

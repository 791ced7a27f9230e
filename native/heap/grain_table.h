// What one grain of a kind does to light, as a table of equally likely outcomes for each angle at which light comes in.
#pragma once

#include <algorithm>
#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "heap/entries.h"
#include "heap/optics.h"
#include "heap/response.h"
#include "heap/sphere_walk.h"
#include "transport/effort.h"

namespace mesograin::heap {

class GrainTable {
 public:
  static constexpr int entries = 16;    ///< intervals of the squared cosine
  static constexpr int outcomes = 512;  ///< of each
  static constexpr int lobe_nodes = 16;
  static constexpr int most_walks = 4096;  ///< for each interval: totals to .2 %

  /// Seconds for thick white media, milliseconds else. `walks` for each interval.
  GrainTable(const Optics& optics, Sense sense, const transport::Effort& effort, int walks = most_walks);

  /// What becomes of light that comes in at this cosine, in the frame of sphere_walk.h; `choice` in [0, 1). Its weight
  /// is what is not left to crossing().
  Outcome draw(float mu, float choice) const;

  /// The share of light at this cosine that goes straight through, without scattering.
  glm::vec3 crossing(float mu) const;

  /// The share that leaves otherwise, of light from everywhere.
  const glm::vec3& albedo() const { return albedo_; }

  /// The share of light from everywhere that does not go straight through, 2 int (1 - crossing) mu dmu.
  const glm::vec3& met() const { return met_; }

  /// Where and in which directions light leaves that comes from everywhere.
  struct Leaving {
    /// Radiance over exitance / pi: at the middles of intervals of the cosine, linear between them, flat beyond.
    std::array<glm::vec3, lobe_nodes> lobe{};
    /// How much of the normal and of the direction is in place().
    glm::vec2 by{1.0F, 0.0F};

    glm::vec3 lobe_at(float mu) const;

    /// By what four numbers know a place of the surface that is seen from a direction. Light is sent on by its
    /// direction as much as by its place where the surface refracts: what of both tells most of where it came from.
    glm::vec3 place(const glm::vec3& normal, const glm::vec3& towards) const { return by.x * normal + by.y * towards; }
  };

  const Leaving& leaving() const { return leaving_; }
  glm::vec3 lobe_at(float mu) const { return leaving_.lobe_at(mu); }

  /// Of what has entered it, if its surface refracts; of leaving() the surface has reflected some.
  const Leaving& entered() const { return entered_; }

  /// Of a turbid grain, what of light that comes in at this cosine leaves it that has entered, by the places that
  /// entered() has.
  const Response& response(float mu) const {
    return responses_[static_cast<std::size_t>(std::min(static_cast<int>(mu * mu * entries), entries - 1))];
  }

  /// Of light from everywhere, the share that leaves a turbid grain and has entered it.
  const glm::vec3& entered_share() const { return entered_share_; }

  /// As of leaving(); in a transparent grain the mean place of what is seen there if it is sent out evenly, some way
  /// below the surface; scaled so that its mean square is that of normals.
  glm::vec3 seen_place(const glm::vec3& normal, const glm::vec3& towards) const;
  float seen_place_scale() const { return seen_place_scale_; }

  /// Whether what it sends out depends on where light came from by more than order 1 tells: where light leaves where it
  /// came in or close by, and where it goes on as through a lens.
  bool is_fine() const { return fine_; }

  /// As Optics::clear().
  bool is_clear() const { return clear_; }

  /// As Optics::turbid().
  bool is_turbid() const { return turbid_; }

  /// Of a clear grain, the share of light from everywhere that is scattered in it, times the albedo of the first of its
  /// scatterings; 0 of others.
  const glm::vec3& scattered() const { return scattered_; }

  /// What leaves of it.
  const glm::vec3& scattered_out() const { return scattered_out_; }

  /// Where light comes in; of what is not opaque.
  const Entries& came_in() const { return came_in_; }

 private:
  void take_albedo(const GrainTable& grey, int channel);
  void find_responses();
  void trace(const Optics& optics, Sense sense, const transport::Effort& effort);

  int walks_;
  bool fine_;
  bool transparent_;
  bool clear_;
  bool turbid_;
  glm::vec3 sigma_t_;
  glm::vec3 met_{1.0F};
  glm::vec3 scattered_{0.0F};
  glm::vec3 scattered_out_{0.0F};
  glm::vec3 albedo_{0.0F};
  std::array<glm::vec3, entries> albedos_{};  // of what light of each interval meets
  std::vector<Outcome> outcomes_;
  Leaving leaving_;
  Leaving entered_;
  std::vector<Response> responses_;
  glm::vec3 entered_share_{0.0F};
  Entries came_in_;
  float seen_place_scale_ = 1.0F;
};

/// Tables that were made before are found by what they were made of: those that somebody has, and the last 64 that
/// nobody has any more, but for those of fewer walks than outcomes, which are soon made again. Each number has random
/// numbers of its own, so that the noise of many kinds' tables is none of their heap's; of one number they stay
/// whatever the grains are made of, so that noise does not flicker while that is dragged.
std::shared_ptr<const GrainTable> grain_table(const Optics& optics, Sense sense, const transport::Effort& effort,
                                              int walks, std::size_t number = 0);

}  // namespace mesograin::heap

// Follows rays of parallel light through the body and leaves at the nodes what they pass.
#include "transport/unscattered.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "transport/incidence.h"
#include "transport/octahedron.h"
#include "transport/random.h"

namespace mesograin::transport {
namespace {

// A ray is given up at its next reflection when so little of it is left, and before when it is next to nothing beside
// what is scattered there.
constexpr float least_flux = 3e-3F;
constexpr float least_track = 1e-4F;
constexpr int most_reflections = 64;
// And one that leaves and enters again for ever, after so many entries.
constexpr int most_beams = 64;

class Tracks {
 public:
  Tracks(const Grid& grid, const std::vector<double>& extinctions)
      : grid_(grid),
        extinctions_(extinctions.begin(), extinctions.end()),
        sums_(grid.places().size() * extinctions.size(), 0.0F),
        passed_(extinctions.size()),
        tracks_(extinctions.size()),
        step_(0.5F * std::min({grid.spacing().x, grid.spacing().y, grid.spacing().z})) {}

  /// Leaves the fluence of a ray of `flux` on its way; each extinction has so much of it left as `left` says.
  void add(const glm::vec3& place, const glm::vec3& direction, float length, float flux, std::vector<float>& left,
           Random& random) {
    const int steps = std::max(1, static_cast<int>(std::ceil(length / step_)));
    const float step = length / static_cast<float>(steps);
    const std::size_t count = extinctions_.size();
    for (std::size_t e = 0; e < count; ++e) {
      passed_[e] = std::exp(-extinctions_[e] * step);
      tracks_[e] = flux * (extinctions_[e] * step > 1e-4F ? (1.0F - passed_[e]) / extinctions_[e] : step);
    }
    for (int s = 0; s < steps; ++s) {
      const auto corners = grid_.corners(place + (static_cast<float>(s) + random.uniform()) * step * direction);
      for (std::size_t e = 0; e < count; ++e) {
        const float track = left[e] * tracks_[e];
        left[e] *= passed_[e];
        for (const Corner& corner : corners)
          sums_[static_cast<std::size_t>(corner.node) * count + e] += track * corner.weight;
      }
      if (flux * *std::max_element(left.begin(), left.end()) < least_track) return;
    }
  }

  std::vector<float> take() { return std::move(sums_); }

 private:
  const Grid& grid_;
  std::vector<float> extinctions_;
  std::vector<float> sums_;
  std::vector<float> passed_;  // of a step, for each extinction
  std::vector<float> tracks_;  // of a whole ray's step
  float step_;
};

// Light on its way into the body, and what of it is left for each extinction.
struct Beam {
  glm::vec3 place;
  glm::vec3 direction;
  float flux;
  std::vector<float> left;
};

/// Where light that comes from `place` outside, reflected or refracted out, enters a body that is not convex (again).
void enter(const Body& body, const Interface& interface, const glm::vec3& place, const glm::vec3& direction, float flux,
           const std::vector<float>& left, Random& random, std::vector<Beam>& beams) {
  if (body.convex() || flux * *std::max_element(left.begin(), left.end()) < least_flux) return;
  const std::optional<Hit> hit = body.first_hit(place, direction);
  if (!hit || glm::dot(hit->normal, direction) >= 0.0F) return;
  const Interface::Entry entry = interface.enter(direction, hit->normal, random);
  beams.push_back({place + hit->distance * direction, entry.inwards, flux * entry.passed, left});
}

void follow(const Body& body, const Interface& interface, Beam beam, Tracks& tracks, Random& random,
            std::vector<Beam>& beams) {
  for (int reflections = 0; reflections <= most_reflections; ++reflections) {
    const std::optional<Hit> hit = body.first_hit(beam.place, beam.direction);
    if (!hit || glm::dot(hit->normal, beam.direction) <= 0.0F) return;
    tracks.add(beam.place, beam.direction, hit->distance, beam.flux, beam.left, random);
    beam.place += hit->distance * beam.direction;
    if (interface.matched()) {
      const std::optional<glm::vec3> entry = body.next_entry(beam.place, beam.direction);
      if (!entry) return;
      beam.place = *entry;
      continue;
    }
    const Interface::Reflection reflection = interface.reflect(beam.direction, hit->normal, random);
    if (reflection.reflected < 1.0F)
      enter(body, interface, beam.place, reflection.beyond, beam.flux * (1.0F - reflection.reflected), beam.left,
            random, beams);
    beam.flux *= reflection.reflected;
    if (beam.flux * *std::max_element(beam.left.begin(), beam.left.end()) < least_flux) return;
    beam.direction = reflection.inwards;
  }
}

}  // namespace

void unscattered_light(const Body& body, const Grid& grid, const Interface& interface,
                       const std::vector<double>& extinctions, int across, const KeepLight& keep,
                       const Effort& effort) {
  run_pieces(effort, octahedron_texels, [&](std::size_t texel) {
    const Incidence incidence(body, octahedron_direction(static_cast<int>(texel)));
    const glm::vec3 towards = -incidence.to_light();
    Random random(effort.seed, texel);
    Tracks tracks(grid, extinctions);
    const auto count = static_cast<float>(across);
    for (int i = 0; i < across * across; ++i) {
      const int row = i / across;
      const glm::vec3 start = incidence.start((static_cast<float>(i % across) + random.uniform()) / count,
                                              (static_cast<float>(row) + random.uniform()) / count);
      const std::optional<Hit> hit = body.first_hit(start, towards);
      if (!hit) continue;
      const Interface::Entry entry = interface.enter(towards, hit->normal, random);
      const glm::vec3 place = start + hit->distance * towards;
      const std::vector<float> whole(extinctions.size(), 1.0F);
      std::vector<Beam> beams = {{place, entry.inwards, entry.passed, whole}};
      if (!interface.matched())
        enter(body, interface, place, entry.mirrored, 1.0F - entry.passed, whole, random, beams);
      for (int turn = 0; turn < most_beams && !beams.empty(); ++turn) {
        Beam beam = std::move(beams.back());
        beams.pop_back();
        follow(body, interface, std::move(beam), tracks, random, beams);
      }
    }
    std::vector<float> radiance = tracks.take();
    const float share = incidence.area() / (count * count * 4.0F * std::numbers::pi_v<float>);
    for (std::size_t node = 0; node < grid.places().size(); ++node)
      for (std::size_t e = 0; e < extinctions.size(); ++e)
        radiance[node * extinctions.size() + e] *= share / std::max(grid.volumes()[node], 1e-12F);
    keep(texel, radiance);
  });
}

}  // namespace mesograin::transport

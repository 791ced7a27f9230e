// Lights too small for paths to find, in a scene of many meshes: what of theirs nothing has scattered yet, in small
// cells of each medium, and where surfaces that scatter it have it from those that bend it.
#pragma once

#include <array>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <unordered_map>
#include <utility>
#include <vector>

#include "heap_matter.h"
#include "light_source.h"
#include "mesh_cells.h"
#include "mesh_heap.h"
#include "rng.h"
#include "scene/light.h"

namespace mesograin::referee {

class UnscatteredLight {
 public:
  /// `rays` of each light, all over the media. Refers to the heap.
  UnscatteredLight(const MeshHeap& heap, const std::vector<Channel>& channels, const std::vector<scene::Light>& lights,
                   std::uint64_t rays, std::uint64_t seed, unsigned threads);

  /// Mean over the part of the place's cell that is inside an instance, in a channel of those given, by its index.
  double fluence(std::uint32_t number, const glm::dvec3& place, std::size_t channel) const;

  /// On an instance's surface, whose `normal` points to the side that is asked for: straight from the lights, of which
  /// one point each is drawn, and what surfaces and media have bent on its way.
  double irradiance(std::uint32_t number, const glm::dvec3& place, const glm::dvec3& normal, std::size_t channel,
                    Rng& rng) const;

  /// The sum over all lights of visit(direction, irradiance) of a point of each, on a plane that faces it: straight, on
  /// the side that a normal points to.
  template <class Visit>
  double straight(const glm::dvec3& place, const glm::dvec3& normal, std::size_t channel, Rng& rng,
                  const Visit& visit) const {
    double sum = 0;
    for (const scene::Light& light : lights_) {
      const SeenPoint seen = see_point(light, place, rng);
      if (glm::dot(normal, seen.direction) <= 0) continue;
      const double comes = left_of(seen, place, channel);
      if (comes > 0) sum += visit(seen.direction, comes);
    }
    return sum;
  }

 private:
  using Power = std::array<float, 3>;

  struct Photon {
    glm::vec3 place;
    glm::vec3 direction;
    std::uint32_t number;
    Power power;
  };

  struct Batch {
    std::vector<float> tracks;  // power times length, all channels of a cell beside each other
    std::vector<Photon> photons;
  };

  void choose_cells();
  void measure(std::vector<float>& tracks) const;
  void trace(const scene::Light& light, std::uint64_t rays, std::uint64_t all, Rng& rng, Batch& batch) const;
  void sort(std::vector<Photon> photons);
  double left_of(const SeenPoint& seen, const glm::dvec3& place, std::size_t channel) const;
  std::int64_t bucket(const glm::ivec3& at) const;

  const MeshHeap& heap_;
  const std::vector<Channel>& channels_;
  std::vector<scene::Light> lights_;
  std::vector<MeshCells> cells_;      // by body
  std::vector<std::size_t> offsets_;  // by instance, in fluence_
  std::vector<float> fluence_;
  double radius_ = 0;  // in which photons are gathered
  std::vector<Photon> photons_;
  std::unordered_map<std::int64_t, std::pair<std::size_t, std::size_t>> buckets_;
};

}  // namespace mesograin::referee

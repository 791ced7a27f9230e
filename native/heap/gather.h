// What a viewer sees of a grain because of what others send, each look by rays of its own: the answer of a grain that
// is seen has more to it than four numbers.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "heap/draws.h"
#include "heap/exchange.h"
#include "heap/facet_walk.h"
#include "heap/heap.h"
#include "transport/random.h"

namespace mesograin::heap {

class Gather {
 public:
  /// `light`: the heap's.
  Gather(Heap heap, std::shared_ptr<const HeapLight> light);
  Gather(const Gather&) = delete;
  Gather& operator=(const Gather&) = delete;

  /// Radiance that leaves a grain at a normal `towards` a viewer, but for what comes straight from lights: the mean
  /// over `rays` through the grain's table, and what is seen straight through it.
  glm::vec3 look(std::uint32_t grain, const glm::vec3& normal, const glm::vec3& towards, int rays,
                 transport::Random& random) const;

  /// Whether look_at_all() knows this grain: what lights do in it is found by asking for them on the way, which no
  /// surface that refracts allows. The whole grain or none of it: a part by each would show an edge between them.
  bool sees_all(std::uint32_t grain) const;

  /// The same with what comes straight from lights, and the world behind it. `place`: of the surface that is seen, from
  /// the grain's middle.
  glm::vec3 look_at_all(std::uint32_t grain, const glm::vec3& place, const glm::vec3& normal, const glm::vec3& towards,
                        int rays, transport::Random& random) const;

  /// Whether so much crosses this grain, whose surface refracts, that look_into() shows more of it.
  bool sees_into(std::uint32_t grain) const;

  /// What look() shows, through the grain's own facets, and of the world, and of suns wide enough to be found, what
  /// crosses it unscattered. Where no other light is, the look goes on through other clear grains that it meets.
  glm::vec3 look_into(const SeenFacet& seen, const Facets& facets, int rays, transport::Random& random) const;

 private:
  glm::vec3 found_through(SeenFacet seen, const Facets& facets, transport::Random& random) const;
  glm::vec3 far_away(const glm::vec3& direction) const;
  glm::vec3 sent_to(Ray ray, transport::Random& random, bool open) const;
  Ray ray_through(std::uint32_t grain, const glm::vec3& normal, const glm::vec3& towards) const;

  Heap heap_;
  std::shared_ptr<const HeapLight> light_;
  Space space_;
  std::vector<Draw> draws_;
  bool looks_find_all_;  // of the light that comes from far away
};

}  // namespace mesograin::heap

// One walk of light through a grain's own facets, from the place where it is seen to where it leaves, or is scattered:
// what a clear crystal shows no sphere of its area does.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>

#include "heap/grains.h"
#include "heap/optics.h"
#include "transport/random.h"

namespace mesograin::heap {

/// How a grain's surface reflects.
struct Finish {
  float roughness;  ///< GGX alpha
  bool shown;       ///< what it mirrors of lights and the world
  bool correlated;  ///< masking and shadowing of its facets
};

/// Of a straight way through a grain.
struct End {
  float distance;
  bool wall;  ///< that reaches into the grain
};

/// Grains' surfaces as they are, and walls, as rays (directions of unit length) meet them.
class Facets {
 public:
  Facets() = default;
  virtual ~Facets() = default;
  Facets(const Facets&) = delete;
  Facets& operator=(const Facets&) = delete;

  /// What is met from inside a grain: its own facets, or a wall that reaches into it.
  virtual std::optional<Meeting> inside(std::uint32_t grain, const glm::vec3& origin,
                                        const glm::vec3& direction) const = 0;

  /// Where only that matters: how far it is from inside a grain to where it ends, in less time.
  virtual std::optional<End> end(std::uint32_t grain, const glm::vec3& origin, const glm::vec3& direction) const;

  /// What is met from a grain's surface on: others, and walls.
  virtual std::optional<Meeting> beyond(std::uint32_t grain, const glm::vec3& origin,
                                        const glm::vec3& direction) const = 0;

  virtual Finish finish(std::uint32_t grain) const = 0;
};

/// A dielectric grain as it is seen at a place of its surface.
struct SeenFacet {
  std::uint32_t grain;
  glm::vec3 place;    ///< from where the heap's places are told from
  glm::vec3 normal;   ///< outwards, unit length
  glm::vec3 towards;  ///< the viewer, unit length
};

/// Light as it leaves, or where it ends, against the way that light goes to the viewer.
struct Passage {
  glm::vec3 place;
  glm::vec3 direction;
  glm::vec3 weight;  ///< linear RGB, of what the viewer sees of that radiance
  bool entered;      ///< else the surface that is seen has reflected it
  bool scattered;
  std::optional<Meeting> wall{};  ///< where it ends, if that is in the grain
  float length = 0.0F;            ///< of its way in the grain
  bool flat = false;              ///< the facet by which it leaves, if it has entered
  glm::vec3 normal{0.0F};         ///< of a cosine lobe in which it leaves; else 0
};

/// What becomes of a view ray that is scattered.
enum class Scatterings {
  followed,
  end,  ///< the walk: its weight has the albedo in it
};

/// Follows a view ray; lengths in `optics` are in `radius`. Where no facet is met, light goes straight on. Nothing,
/// where all was absorbed or it does not come out.
std::optional<Passage> walk_facets(const Optics& optics, float radius, const SeenFacet& seen, const Facets& facets,
                                   Scatterings scatterings, transport::Random& random);

}  // namespace mesograin::heap

// One walk of light through a grain's own facets, from the place where it is seen to where it leaves, or is scattered:
// what a clear crystal shows no sphere of its area does.
#pragma once

#include <cstdint>
#include <functional>
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

  /// What is met from a grain's surface on, or, for `nobody`, a wall's: others, and walls.
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
  int reflected = 0;              ///< inside, so many times
};

/// What becomes of a view ray that is scattered.
enum class Scatterings {
  followed,
  end,  ///< the walk: its weight has the albedo in it
};

/// Told of each facet that a view ray meets from inside, before it is known whether it leaves there. `inwards`: the
/// facet's normal, against the ray.
using AtFacet = std::function<void(const Passage& arriving, const glm::vec3& inwards)>;

/// Follows a view ray; lengths in `optics` are in `radius`. Where no facet is met, light goes straight on. Nothing,
/// where all was absorbed or it does not come out.
std::optional<Passage> walk_facets(const Optics& optics, float radius, const SeenFacet& seen, const Facets& facets,
                                   Scatterings scatterings, transport::Random& random, const AtFacet& at_facet = {});

/// How likely a ray leaves by one microfacet of a rough surface in a direction beyond it, per steradian, as
/// walk_facets() has it leave (Walter et al. 2007, eq. 15 to 17 and 21; normals as the ray sees them: Heitz 2018, eq. 2
/// and 3). `normal`: against what is `travelling`; `eta`: beyond the surface over before it, not 1.
double leaving_density(const glm::dvec3& normal, double alpha, double eta, const glm::dvec3& travelling,
                       const glm::dvec3& beyond);

}  // namespace mesograin::heap

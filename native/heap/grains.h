// The grains of a heap as light between them sees them, spheres, each of a kind, and the walls around them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "heap/optics.h"
#include "heap/panes.h"
#include "heap/walls.h"

namespace mesograin::heap {

struct Grain {
  glm::vec3 middle;  ///< from a place amid the heap
  float radius;
  std::uint32_t kind;      ///< which of Grains::kinds
  float thickness = 1.0F;  ///< its radius over the one that its kind is for; more than 1 if it is no ball

  /// In which the kind's lengths are told.
  float radius_of_kind() const { return radius / thickness; }

  bool operator==(const Grain&) const = default;
};

struct Grains {
  std::vector<Grain> grains;
  std::vector<Optics> kinds;
  std::vector<Wall> walls;
  std::vector<Pane> panes;  ///< in the order of the grains that they are

  /// The number of a kind of these optics, added if there is none.
  std::uint32_t kind(const Optics& optics);

  bool operator==(const Grains&) const = default;
};

/// Whether walls are where the others are, whatever they are made of.
bool same_walls(const std::vector<Wall>& a, const std::vector<Wall>& b);

/// The same of grains, walls and panes.
bool same_places(const Grains& a, const Grains& b);

/// In place of a grain's number.
inline constexpr std::uint32_t nobody = ~0U;

/// Which grain or wall a ray meets, and where.
struct Meeting {
  bool wall;
  std::uint32_t number;  ///< of the grain or the wall
  glm::vec3 place;
  glm::vec3 normal;   ///< against the ray; of a grain outwards
  bool flat = false;  ///< the surface does not bend there
};

/// A surface of a pane, as a ray meets it.
struct PaneSurface {
  std::uint32_t pane;
  float distance;
  glm::vec3 normal;  ///< outwards

  bool met_from_outside(const glm::vec3& direction) const { return glm::dot(normal, direction) < 0.0F; }
};

/// Grains and walls as rays find them, which pass panes (Embree). Places in it come from Grains.
class Neighbourhood {
 public:
  explicit Neighbourhood(const Grains& grains);

  /// Whether both are one: a copy is.
  bool operator==(const Neighbourhood&) const = default;

  /// The first grain that a ray comes to from outside, or wall. A grain that it starts in, and goes deeper into, is met
  /// where it starts: the balls of grains that are none reach into each other where those touch. Of `from`, whose own
  /// surface it leaves, that is not so.
  std::optional<Meeting> first(const glm::vec3& origin, const glm::vec3& direction, std::uint32_t from = nobody) const;

  /// Where a ray first meets any wall within `reach`.
  std::optional<Meeting> first_wall(const glm::vec3& origin, const glm::vec3& direction, float reach) const;

  /// Where a ray meets this wall within `reach`.
  std::optional<Meeting> first_on(std::uint32_t wall, const glm::vec3& origin, const glm::vec3& direction,
                                  float reach) const;

  /// The first surface of a pane beyond `near` and within `reach`.
  std::optional<PaneSurface> first_pane(const glm::vec3& origin, const glm::vec3& direction, float near,
                                        float reach) const;

 private:
  struct Device;
  std::shared_ptr<const Device> device_;
};

}  // namespace mesograin::heap

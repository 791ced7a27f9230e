// Many meshes where they stand, in a tree of boxes over each one's own.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "box.h"
#include "mesh_body.h"
#include "scene/scene.h"

namespace mesograin::referee {

class MeshHeap {
 public:
  /// All instances of a scene, and of its arrays. Throws Error where instances of an array differ in colour.
  explicit MeshHeap(const scene::Scene& scene);

  struct Hit {
    std::uint32_t number;  ///< of the instance
    double distance;
    glm::dvec3 normal;  ///< of the flat triangle, unit length: out of the body
  };

  /// What a ray meets in free space (`direction` has unit length): bodies at places where it enters them, and surfaces
  /// that are none from either side.
  std::optional<Hit> first(const glm::dvec3& origin, const glm::dvec3& direction) const;

  /// Its own surface, from within an instance.
  std::optional<Hit> inside(std::uint32_t number, const glm::dvec3& origin, const glm::dvec3& direction) const;

  std::size_t size() const { return placed_.size(); }
  const scene::Material& material(std::uint32_t number) const { return *placed_[number].material; }
  const Box& box(std::uint32_t number) const { return placed_[number].box; }
  bool is_solid(std::uint32_t number) const { return placed_[number].solid; }
  const glm::dmat4& to_world(std::uint32_t number) const { return placed_[number].to_world; }
  const glm::dmat4& to_body(std::uint32_t number) const { return placed_[number].to_body; }

  const std::vector<MeshBody>& bodies() const { return bodies_; }
  std::size_t body_index(std::uint32_t number) const { return placed_[number].body; }
  const MeshBody& body(std::uint32_t number) const { return bodies_[placed_[number].body]; }

  /// Of all, or of those alone that light goes on in, of which there must be one.
  Box bounds(bool solid) const;

 private:
  struct Placed {
    std::size_t body;
    const scene::Material* material;
    glm::dmat4 to_world, to_body;
    Box box;
    bool solid;  // light goes on in it
  };
  struct Node {
    Box box;
    std::size_t first, count;  // instances of a leaf, or the second child (the first one is next) and 0
  };

  void place(std::size_t body, const scene::Material& material, const glm::dmat4& to_world);
  void build(std::size_t first, std::size_t last);
  std::optional<Hit> meet(std::uint32_t number, const glm::dvec3& origin, const glm::dvec3& direction,
                          bool enters) const;

  std::vector<MeshBody> bodies_;
  std::vector<scene::Material> materials_;
  std::vector<Placed> placed_;
  std::vector<Node> nodes_;
};

}  // namespace mesograin::referee

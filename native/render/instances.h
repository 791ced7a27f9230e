// A scene's arrays of instances on the device: a transform each, in groups that are drawn and shaded together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "casting/placed_tree.h"
#include "gl/buffer.h"
#include "render/bounds.h"
#include "render/details.h"
#include "render/device_cache.h"
#include "render/instance_classes.h"
#include "render/light_map_atlas.h"
#include "scene/scene.h"

namespace mesograin::render {

/// As many instances of one mesh and material are drawn as an array; fewer are drawn one by one, exactly.
inline constexpr std::size_t fewest_in_array = 9;

/// A mesh as its instances share it.
struct Prototype {
  scene::MeshPointer mesh;
  std::shared_ptr<Details> details;
  bool convex;
  std::unique_ptr<LightMapAtlas> light_maps;  // once a material reads them
};

/// Instances that one call draws and one program shades: of one prototype and one material, and, where the material's
/// tables depend on the grain's radius, of about one size.
struct InstanceGroup {
  std::size_t prototype;
  std::shared_ptr<DeviceMaterial> material;
  scene::Material source;         // of the material
  double typical_scale;           // of the instances that the material's tables were made for
  double mean_free_paths_across;  // reduced, in the densest channel
  float largest = 0.0F;           // of the instances' balls
  glm::mat3 unstretch{1.0F};      // of a material that depends on the mesh: what makes an instance's transform a turn
  std::uint32_t first;            // instance; they lie one after the other
  std::uint32_t count;

  /// What shades no more than its surface, made when it is first asked for.
  const std::shared_ptr<DeviceMaterial>& surface(DeviceCache& cache) const;

 private:
  mutable std::shared_ptr<DeviceMaterial> surface_;
};

/// Which instances a picture draws, by group and level of detail.
struct Selection {
  struct Part {
    std::size_t group;
    std::size_t level;
    std::uint32_t first;  // in `instances`
    std::uint32_t count;
  };
  std::vector<Part> parts;
  std::vector<std::uint32_t> instances;
  double largest_pixels_across = 0.0;
};

class Instances {
 public:
  /// Takes the arrays of a scene. `anchor`, a place amid the scene, is the origin of all that is on the device.
  Instances(DeviceCache& cache, const std::vector<scene::InstanceArray>& arrays, const glm::dvec3& anchor);

  /// Puts them where these arrays have them, which differ in nothing else from those that they were made of; each keeps
  /// its group.
  void place(const std::vector<scene::InstanceArray>& arrays, const glm::dvec3& anchor);

  /// Takes over what was made for the same instances in the same order, whatever their materials are: a material's
  /// change costs no tree and sends nothing.
  void take_places(Instances& before);

  /// Frees those that no material reads any more.
  void drop_light_maps();

  /// Takes over the light maps of prototypes that were there before.
  void take_light_maps(Instances& before);

  const std::vector<InstanceGroup>& groups() const { return groups_; }
  std::vector<Prototype>& prototypes() { return prototypes_; }
  const std::vector<Prototype>& prototypes() const { return prototypes_; }
  std::size_t count() const { return radii_.size(); }

  /// The ball that holds an instance: xyz its middle, from the anchor; w its radius.
  glm::vec4 ball(std::size_t instance) const {
    const glm::vec4* of = rows(instance);
    return {of[0].w, of[1].w, of[2].w, radii_[instance]};
  }

  /// Three rows of its transform: object to anchor's space, the middle of the bounds at the origin.
  const glm::vec4* rows(std::size_t instance) const { return &rows_[3 * instance]; }

  /// The group that an instance is one of.
  const InstanceGroup& group_of(std::size_t instance) const;

  /// Whether, for all that the model knows, a part of an instance may stand in another's light.
  bool shades_itself(const InstanceGroup& group) const;
  bool shades_itself(std::size_t instance) const { return shades_itself(group_of(instance)); }

  /// Of all, from the anchor.
  const Bounds& bounds() const { return bounds_; }

  /// What rays are cast into; made on first use. Its groups are these.
  const casting::PlacedTree& tree(DeviceCache& cache);

  /// The same for rays that the device follows, as shaders/scene/rays.glsl reads it; made on first use. Throws Error if
  /// there are too many.
  const gl::Buffer& device_tree();

  /// Those that a picture of `width` x `height` pixels may show, `anchor_to_clip` being its projection.
  Selection select(const glm::dmat4& anchor_to_clip, int width, int height) const;

  /// The directions, in the prototype's own axes, from which lights in these directions (unit length) meet its
  /// instances.
  LightMapDirections light_directions(std::size_t prototype, const std::vector<glm::dvec3>& to_light) const;

  /// Makes them what shaders/scene/instances.glsl reads.
  void bind() const;

 private:
  void add(DeviceCache& cache, const scene::InstanceArray& array, const std::vector<InstanceClass>& classes,
           const glm::dvec3& anchor);
  std::size_t prototype(DeviceCache& cache, const scene::MeshPointer& mesh);
  void find_largest();
  void place(std::size_t instance, const scene::Mesh& mesh, const glm::dmat4& object_to_world,
             const glm::dvec3& anchor);

  std::vector<Prototype> prototypes_;
  std::vector<InstanceGroup> groups_;
  std::vector<glm::vec4> rows_;         // three an instance
  std::vector<float> radii_;            // of the balls
  std::vector<std::uint32_t> members_;  // of each instance, which it is of its array; empty where they are in order
  Bounds bounds_;
  std::unique_ptr<casting::PlacedTree> tree_;
  std::optional<gl::Buffer> device_tree_;
  mutable std::optional<gl::Buffer> device_;  // the rows, sent on first use
};

}  // namespace mesograin::render
